/** Colours of the drawing, for light and for dark surroundings. Groups have the colours of Okabe and Ito. */

export interface Theme {
  isDark: boolean;
  ground: string;
  wall: string;
  ink: string;
  soft: string;
  faint: string;
  debris: string;
  movable: string;
  rescuee: string;
  radiation: string;
  radiationEdge: string;
  wait: string;
  ungrouped: string;
  energy: string;
  hp: string;
  halo: string;
  groups: string[];
}

const LIGHT: Theme = {
  isDark: false,
  ground: '#fbfbf9',
  wall: '#4a4f57',
  ink: '#1d2127',
  soft: '#68707b',
  faint: '#d5d8dc',
  debris: '#8c8a84',
  movable: '#c3b79c',
  rescuee: '#3b414a',
  radiation: '214, 168, 0',
  radiationEdge: '#a98500',
  wait: '#c2185b',
  ungrouped: '#7b8290',
  energy: '#009e73',
  hp: '#cc79a7',
  halo: '#ffffff',
  groups: ['#0072b2', '#d98200', '#009e73', '#cc79a7', '#d55e00', '#56b4e9', '#8a7d00'],
};

const DARK: Theme = {
  isDark: true,
  ground: '#14171b',
  wall: '#9aa3ae',
  ink: '#eceff3',
  soft: '#98a1ad',
  faint: '#2c323a',
  debris: '#6f7278',
  movable: '#8d7f61',
  rescuee: '#c3cad3',
  radiation: '240, 228, 66',
  radiationEdge: '#c8bd3a',
  wait: '#ff7ab0',
  ungrouped: '#9aa2b0',
  energy: '#2fc497',
  hp: '#e39cc3',
  halo: '#0c0e11',
  groups: ['#56b4e9', '#e69f00', '#2fc497', '#e39cc3', '#f0793a', '#4a90d0', '#f0e442'],
};

const dark = window.matchMedia('(prefers-color-scheme: dark)');

export const theme = (): Theme => (dark.matches ? DARK : LIGHT);

export function onThemeChange(listen: () => void, signal: AbortSignal): void {
  dark.addEventListener('change', listen, { signal });
}

/** The colour of a group, by its task; null is a robot without a group. */
export function groupColour(task: number | null): string {
  const { groups, ungrouped } = theme();
  return task === null ? ungrouped : groups[task % groups.length];
}
