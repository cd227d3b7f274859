/** Elements with their texts. Every text of a recording is text: nothing here reads markup. */

type Attributes = Record<string, string>;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** A button with its action; `title` says what it does. */
export function button(text: string, title: string, act: () => void, kind = ''): HTMLButtonElement {
  const made = element('button', { type: 'button', title, 'aria-label': title, class: kind }, text);
  made.addEventListener('click', act);
  return made;
}

/** A square in a colour. */
export function swatch(colour: string): HTMLElement {
  const made = element('span', { class: 'swatch' });
  made.style.background = colour;
  return made;
}

/** A canvas with its context, as large as its place and as fine as the screen. */
export class Sheet {
  readonly canvas: HTMLCanvasElement;
  readonly context: CanvasRenderingContext2D;
  ratio = 1;
  width = 1;
  height = 1;

  constructor(attributes: Attributes, resized: () => void) {
    this.canvas = element('canvas', attributes);
    this.context = this.canvas.getContext('2d')!;
    new ResizeObserver(() => {
      this.measure();
      resized();
    }).observe(this.canvas);
  }

  /** Acts where a pointer goes down, and wherever it is drawn from there. */
  onDrag(act: (event: PointerEvent) => void): void {
    const { canvas } = this;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      act(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) act(event);
    });
  }

  private measure(): void {
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.width * this.ratio);
    this.canvas.height = Math.round(this.height * this.ratio);
  }

  /** Begins a drawing, in pixels of the page. */
  begin(): CanvasRenderingContext2D {
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    return this.context;
  }
}

/** `snake_case` as words. */
export const words = (name: string): string => name.replaceAll('_', ' ');

/** A time in seconds as minutes and seconds. */
export function clockTime(seconds: number): string {
  const tenths = Math.floor(seconds * 10 + 1e-6);
  const whole = Math.floor(tenths / 10);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}.${tenths % 10}`;
}
