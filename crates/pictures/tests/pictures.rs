//! Pictures of a recorded trial: their content, and that they are the same on every machine.

use std::path::Path;

use pictures::{Animation, Look, Picture, PictureError, Pixels, Plan, Width, moment, plan, trails};
use recording::{Options, Recording, World, record};
use scenario::Scenario;
use usar_sim::simulation::Simulation;

fn scenario(file: &str, duration_s: f64) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(file);
    let (scenario, _) = Scenario::load(&path).unwrap();
    let mut file = (*scenario).clone();
    file.duration_s = duration_s;
    Scenario::try_from(file).unwrap()
}

fn recorded(scenario: &Scenario) -> Recording {
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut bytes = Vec::new();
    let simulation = Simulation::new(scenario, 1).unwrap();
    record(
        simulation,
        &mut *policy,
        &Options::new("RNE", policies::standard().measure("RNE").ok()),
        &mut bytes,
    )
    .unwrap();
    Recording::read(&bytes).unwrap()
}

fn drawn(scenario: &Scenario, look: &Look) -> Picture {
    let world = World::of(&Simulation::new(scenario, 1).unwrap());
    let first_sampled = [scenario.debris.len(), scenario.radiation.len()];
    plan(&Plan { title: "a <b> & \"c\"", world: &world, errands: &scenario.errands, first_sampled }, look)
}

/// Number of pixels with exactly this colour.
fn count(pixels: &Pixels, colour: [u8; 3]) -> usize {
    pixels.rgba.as_chunks::<4>().0.iter().filter(|pixel| pixel[..3] == colour).count()
}

#[test]
fn a_moment_shows_each_robot_where_the_recording_has_it() {
    let recording = recorded(&scenario("paper.ron", 40.0));
    let look = Look { width: Width::Pixels(720), has_title: false, has_legend: false, ..Look::default() };
    let number = recording.frame_at(30.0);
    let pixels = moment(&recording, number, &look).unwrap().pixels().unwrap();
    let frame = recording.frame(number).unwrap();
    let arena = recording.header.world.arena_m;
    let margin = 7.0 * 720.0 / 700.0;
    let scale = (720.0 - 2.0 * margin) / arena[0];
    let group = [[0x00, 0x72, 0xb2], [0xd9, 0x82, 0x00]];
    let mut seen = 0;
    for robot in &frame.robots {
        let [x, y] = robot.motion.position_mm.map(|mm| f64::from(mm) / 1000.0);
        let (x, y) = (margin + scale * x, margin + scale * (arena[1] - y));
        let at = 4 * (y as usize * pixels.width as usize + x as usize);
        let task = robot.state.task.unwrap() as usize;
        seen += usize::from(pixels.rgba[at..at + 3] == group[task]);
    }
    // A robot may be hidden by another robot's sign or by a link.
    assert!(seen >= frame.robots.len() - 2, "{seen} of {} robots", frame.robots.len());
}

#[test]
fn pictures_are_the_same_every_time_and_text_needs_no_font_of_the_machine() {
    let scenario = scenario("paper.ron", 20.0);
    let recording = recorded(&scenario);
    let look = Look::default();
    let picture = moment(&recording, 100, &look).unwrap();
    assert_eq!(picture, moment(&recording, 100, &look).unwrap());
    let png = picture.png().unwrap();
    assert_eq!(png, picture.png().unwrap());
    assert_eq!(&png[1..4], b"PNG");
    assert_ne!(picture, moment(&recording, 150, &look).unwrap());
    let without = Look { has_title: false, has_legend: false, ..Look::default() };
    let [with, without] = [&look, &without].map(|look| drawn(&scenario, look).pixels().unwrap());
    let ink = [0x1d, 0x21, 0x27];
    assert!(count(&with, ink) > count(&without, ink) + 300, "letters are drawn");
}

#[test]
fn a_plan_says_what_it_shows_and_names_are_no_markup() {
    let svg = |file: &str| drawn(&scenario(file, 20.0), &Look::default()).svg().to_owned();
    let paper = svg("paper.ron");
    assert!(paper.contains("a &lt;b&gt; &amp; &quot;c&quot;") && !paper.contains("<b>"));
    for word in
        ["carrier", "easy", "hard", "rest", "home", "sensing range", "radiation", "10 m", "movable debris"]
    {
        assert!(paper.contains(&format!(">{word}<")), "{word}");
    }
    assert!(!paper.contains(">errands<"));
    assert!(svg("minimal/head_on.ron").contains(">errands<"));
}

#[test]
fn trails_end_where_the_robots_do_and_fit_a_column() {
    let recording = recorded(&scenario("minimal/head_on.ron", 60.0));
    let look = Look { width: Width::Millimetres(88.0), ..Look::default() };
    let picture = trails(&recording, &look).unwrap();
    assert!(picture.svg().starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"88."));
    let pixels = picture.pixels().unwrap();
    assert_eq!(pixels.width, (333.0_f64 * 300.0 / 96.0).round() as u32, "88 mm with 300 dots in an inch");
    let ways = picture.svg().matches("stroke-opacity=\"0.5\"").count();
    assert_eq!(ways, recording.header.world.robots.len());
    let large = Look { width: Width::Millimetres(1000.0), dpi: 1200.0, ..Look::default() };
    assert!(matches!(trails(&recording, &large).unwrap().png(), Err(PictureError::TooLarge { .. })));
}

#[test]
fn an_animation_has_every_picture_when_it_is_decoded() {
    let recording = recorded(&scenario("minimal/head_on.ron", 12.0));
    let look = Look { width: Width::Pixels(240), ..Look::default() };
    let numbers: Vec<usize> = (0..recording.frames()).step_by(10).collect();
    let pictures: Vec<Pixels> =
        numbers.iter().map(|number| moment(&recording, *number, &look).unwrap().pixels().unwrap()).collect();
    let mut gif = Animation::begin(Vec::new(), &[pictures[0].clone(), pictures[5].clone()], 10).unwrap();
    pictures.iter().for_each(|picture| gif.push(picture).unwrap());
    let other = Pixels { width: 1, height: 1, rgba: vec![0; 4] };
    assert!(matches!(gif.push(&other), Err(PictureError::OtherSize)));
    let bytes = gif.finish().unwrap();
    let mut decoder = gif::Decoder::new(&*bytes).unwrap();
    let colours = decoder.global_palette().unwrap().to_vec();
    let mut canvas = vec![[0_u8; 3]; pictures[0].rgba.len() / 4];
    for picture in &pictures {
        let frame = decoder.read_next_frame().unwrap().expect("as many frames as pictures");
        for (i, number) in
            frame.buffer.iter().enumerate().filter(|(_, number)| Some(**number) != frame.transparent)
        {
            let (row, column) = (i / usize::from(frame.width), i % usize::from(frame.width));
            let at =
                (row + usize::from(frame.top)) * picture.width as usize + column + usize::from(frame.left);
            canvas[at].copy_from_slice(&colours[3 * usize::from(*number)..][..3]);
        }
        let apart = canvas.iter().zip(picture.rgba.as_chunks::<4>().0).map(|(shown, pixel)| {
            shown.iter().zip(pixel).map(|(shown, drawn)| u32::from(shown.abs_diff(*drawn))).sum::<u32>()
        });
        let far = apart.filter(|apart| *apart > 60).count();
        assert!(far < canvas.len() / 200, "{far} pixels have another colour");
    }
    assert!(decoder.read_next_frame().unwrap().is_none());
}
