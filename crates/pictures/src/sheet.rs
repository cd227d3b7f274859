//! A sheet with the map of an arena, a title above it, and a scale and a legend below it.

use scenario::Point;

use crate::legend::{Entry, Legend};
use crate::picture::{FONTS, Look, Picture};
use crate::svg::{Anchor, At, Lettering, Num, Svg};
use crate::theme::{INK, PAPER};

/// Width of a sheet on which signs have their normal size, in pixels.
const USUAL_WIDTH: f64 = 700.0;

/// Largest ratio of height to width of a map.
const HIGHEST: f64 = 1.4;

/// A sheet on which a map is drawn.
pub(crate) struct Sheet<'l> {
    pub(crate) svg: Svg,
    /// Size of signs relative to a sheet of normal width: signs grow with the sheet, within limits.
    pub(crate) unit: f64,
    /// Pixels in a metre.
    pub(crate) scale: f64,
    look: &'l Look,
    /// Position of the arena's lower left corner on the sheet.
    origin: At,
    /// Width and height of the arena, in metres.
    arena: Point,
    width: f64,
}

impl<'l> Sheet<'l> {
    /// An empty sheet for an arena of this size, in metres.
    pub(crate) fn new(look: &'l Look, arena: Point, title: &str) -> Self {
        let width = look.width_px();
        let unit = (width / USUAL_WIDTH).clamp(0.75, 3.0);
        let margin = 7.0 * unit;
        let room = width - 2.0 * margin;
        let scale = (room / arena[0]).min(HIGHEST * room / arena[1]);
        let top = if look.has_title { margin + 20.0 * unit } else { margin };
        let origin = [(width - scale * arena[0]) / 2.0, top + scale * arena[1]];
        let mut sheet = Self { svg: Svg::default(), unit, scale, look, origin, arena, width };
        if look.has_title {
            let at = [margin, margin + 6.0 * unit];
            sheet.svg.text(title, at, &Lettering { size: 12.0 * unit, anchor: Anchor::Start, colour: INK });
        }
        sheet
    }

    /// The position on the sheet of a place in the arena.
    pub(crate) fn at(&self, [x, y]: Point) -> At {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }

    /// The position on the sheet of a place in millimetres.
    pub(crate) fn at_mm(&self, place: [i32; 2]) -> At {
        self.at(place.map(|mm| f64::from(mm) / 1000.0))
    }

    /// Upper left corner and size of the map.
    pub(crate) fn map(&self) -> [At; 2] {
        [self.at([0.0, self.arena[1]]), self.arena.map(|length| self.scale * length)]
    }

    /// Completes the picture, with the legend below the map.
    pub(crate) fn finish(mut self, entries: Vec<Entry>) -> Picture {
        let margin = 7.0 * self.unit;
        let mut height = self.origin[1] + margin;
        if self.look.has_legend {
            let legend = Legend { left: margin, right: self.width - margin, top: height, unit: self.unit };
            height = legend.draw(&mut self.svg, self.scale, self.arena[0], entries) + margin * 0.5;
        }
        let (width, height) = (self.width.round(), height.ceil());
        let size = [width, height].map(|length| self.look.length(length));
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
             font-family=\"{FONTS}\">\n<rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>\n{}</svg>\n",
            size[0],
            size[1],
            Num(width),
            Num(height),
            self.svg.0
        );
        Picture::new(svg, self.look)
    }
}
