/** The keys of the viewer, and when they are not its keys. */

/** What keys do. */
export interface KeyActions {
  toggle: () => void;
  /** Goes on by so many seconds. */
  step: (seconds: number) => void;
  toStart: () => void;
  toEnd: () => void;
  faster: (by: 1 | -1) => void;
  toRound: (by: 1 | -1) => void;
  askTime: () => void;
  copyLink: () => void;
  follow: () => void;
  routes: () => void;
  links: () => void;
  messages: () => void;
  team: () => void;
  help: () => void;
}

/** Elements that take text or keys of their own. */
const FIELDS = 'input, textarea, select, [contenteditable]:not([contenteditable="false"]), .cm-editor';

/** Whether a key is typed into a field or an editor: then it is not the viewer's. */
export function isTyped({ target }: Pick<Event, 'target'>): boolean {
  const element = target as Partial<Element> | null;
  return typeof element?.closest === 'function' && element.closest(FIELDS) !== null;
}

/** What a key does; undefined if it does nothing. */
export function actionOf(event: KeyboardEvent, actions: KeyActions): (() => void) | undefined {
  if (event.ctrlKey || event.metaKey || event.altKey || isTyped(event)) return undefined;
  const step = event.shiftKey ? 10 : 1;
  const bound: Record<string, () => void> = {
    ' ': actions.toggle,
    ArrowLeft: actions.step.bind(null, -step),
    ArrowRight: actions.step.bind(null, step),
    Home: actions.toStart,
    End: actions.toEnd,
    '+': actions.faster.bind(null, 1),
    '=': actions.faster.bind(null, 1),
    '-': actions.faster.bind(null, -1),
    '[': actions.toRound.bind(null, -1),
    ']': actions.toRound.bind(null, 1),
    g: actions.askTime,
    c: actions.copyLink,
    f: actions.follow,
    r: actions.routes,
    w: actions.links,
    m: actions.messages,
    Escape: actions.team,
    '?': actions.help,
  };
  return Object.hasOwn(bound, event.key) ? bound[event.key] : undefined;
}
