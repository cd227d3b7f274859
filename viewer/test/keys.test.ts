import { describe, expect, it } from 'vitest';
import { type KeyActions, actionOf, isTyped } from '../src/ui/keys';

/** An element that lies within elements of these kinds, as far as `closest` tells. */
const within = (...kinds: string[]): EventTarget =>
  ({
    closest: (selector: string) => (kinds.some((kind) => selector.split(', ').includes(kind)) ? {} : null),
  }) as unknown as EventTarget;

const key = (name: string, target: EventTarget, more: Partial<KeyboardEvent> = {}): KeyboardEvent =>
  ({
    key: name,
    target,
    ctrlKey: false,
    metaKey: false,
    altKey: false,
    shiftKey: false,
    ...more,
  }) as KeyboardEvent;

/** Actions that note their names. */
function noting(): { actions: KeyActions; done: string[] } {
  const done: string[] = [];
  const note = (_: unknown, name: string) => (by?: unknown) =>
    done.push(name + (by === undefined ? '' : ` ${by as number}`));
  return {
    actions: new Proxy({} as KeyActions, { get: (target, name) => note(target, String(name)) }),
    done,
  };
}

describe('keys', () => {
  it('typed into a field or an editor are not those of the viewer', () => {
    const fields = ['input', 'textarea', 'select', '.cm-editor'];
    for (const field of fields) expect(isTyped({ target: within(field) }), field).toBe(true);
    expect(isTyped({ target: within('button') })).toBe(false);
    expect(isTyped({ target: null })).toBe(false);
    const { actions } = noting();
    for (const name of '// a b[c]')
      expect(actionOf(key(name, within('.cm-editor')), actions)).toBeUndefined();
  });

  it('elsewhere do what they say', () => {
    const { actions, done } = noting();
    const press = (name: string, more?: Partial<KeyboardEvent>): void =>
      actionOf(key(name, within(), more), actions)?.();
    for (const name of [' ', '[', '+', 'g', 'x', 'toString']) press(name);
    press('ArrowLeft', { shiftKey: true });
    press('c', { ctrlKey: true });
    expect(done).toEqual(['toggle', 'toRound -1', 'faster 1', 'askTime', 'step -10']);
  });
});
