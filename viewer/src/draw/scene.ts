/** Draws the state at a moment from above. */

import type { Moment, Recording } from '../recording/recording';
import { positionOf } from '../recording/state';
import { drawAround } from './around';
import type { Camera } from './camera';
import { drawGround, drawGroundObjects, drawNames, drawRescuees } from './ground';
import type { Labels } from './labels';
import { drawMessages } from './messages';
import { drawConflicts, drawLinks, drawRobots, radiiOf, drawRoutes, drawTrails } from './robots';
import { LARGE_TEAM, type Looks, type Sheet } from './sheet';
import { theme } from './theme';

export function drawScene(
  context: CanvasRenderingContext2D,
  ratio: number,
  camera: Camera,
  recording: Recording,
  moment: Moment,
  looks: Looks,
  labels: Labels,
): void {
  const sheet: Sheet = { context, ratio, camera, recording, moment, looks, colours: theme(), labels };
  labels.begin([camera.width, camera.height]);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, camera.width, camera.height);
  drawGround(sheet);
  drawGroundObjects(sheet);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawNames(sheet);
  drawRescuees(sheet);
  const robots = recording.header.world.robots.length;
  const places = Array.from({ length: robots }, (_, i) => camera.toScreen(positionOf(recording, moment, i)));
  if (robots <= LARGE_TEAM) drawTrails(sheet, places);
  drawRoutes(sheet, places);
  if (looks.messages) drawMessages(sheet, places);
  const radii = radiiOf(sheet);
  drawRobots(sheet, places, radii);
  if (looks.links) {
    drawLinks(sheet, places);
    if (robots <= LARGE_TEAM) drawConflicts(sheet, places);
  }
  drawAround(sheet, places, radii);
}
