/** What a drawing needs all along. */

import type { Moment, Recording } from '../recording/recording';
import type { Camera } from './camera';
import type { Labels } from './labels';
import type { Theme } from './theme';

/** What is shown besides the state. */
export interface Looks {
  /** Whose knowledge is shown: a task's number, that of tasks for the team at home, null for the truth. */
  viewpoint: number | null;
  routes: boolean;
  links: boolean;
  messages: boolean;
  selected: number | null;
}

/** What a drawing needs all along. */
export interface Sheet {
  context: CanvasRenderingContext2D;
  ratio: number;
  camera: Camera;
  recording: Recording;
  moment: Moment;
  looks: Looks;
  colours: Theme;
  labels: Labels;
}

/** Teams that are larger than this are drawn without bars and trails. */
export const LARGE_TEAM = 150;
