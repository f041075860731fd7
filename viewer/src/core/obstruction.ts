// What of the sky a point sees, and when the sun comes through: for the sun-path diagram of a measured place.
import { sunPosition, type Site } from './sun_position';
import type { Vec3 } from './units';

/** Cells of the dome are this wide and high, degrees. */
export const cellDeg = 2;
export const columns = 360 / cellDeg;
export const rows = 90 / cellDeg;

/** Free, blocked by the city, or behind the surface itself. */
export type CellState = 0 | 1 | 2;

/** The dome about a point, row 0 at the horizon, column 0 from grid north on, clockwise. */
export type Dome = Uint8Array;

/** Unit vector (world, z up) to a place of the sky. Azimuth is clockwise from grid north. */
export function directionTo(azimuthDeg: number, elevationDeg: number): Vec3 {
  const [a, e] = [(azimuthDeg * Math.PI) / 180, (elevationDeg * Math.PI) / 180];
  return [Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), Math.sin(e)];
}

/** @param isBlocked whether the city stands in a direction */
export function domeOf(normal: Vec3, isBlocked: (direction: Vec3) => boolean): Dome {
  const dome = new Uint8Array(columns * rows);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const direction = directionTo((column + 0.5) * cellDeg, (row + 0.5) * cellDeg);
      const isBehind = direction[0] * normal[0] + direction[1] * normal[1] + direction[2] * normal[2] <= 0;
      dome[row * columns + column] = isBehind ? 2 : isBlocked(direction) ? 1 : 0;
    }
  }
  return dome;
}

export interface SunPoint {
  utcMs: number;
  /** From grid north. */
  azimuthDeg: number;
  elevationDeg: number;
}

const minute = 60_000;

/** The sun's way above the horizon through the day (of local solar time) that an instant lies in, every `stepMinutes`. */
export function sunPath(utcMs: number, site: Site, convergenceDeg: number, stepMinutes: number): SunPoint[] {
  const solarOffset = site.longitude_deg * 4 * minute;
  const dayStart = Math.floor((utcMs + solarOffset) / (1440 * minute)) * 1440 * minute - solarOffset;
  const points: SunPoint[] = [];
  for (let at = dayStart; at <= dayStart + 1440 * minute; at += stepMinutes * minute) {
    const { azimuthDeg, elevationDeg } = sunPosition(at, site);
    if (elevationDeg >= 0) points.push({ utcMs: at, azimuthDeg: azimuthDeg - convergenceDeg, elevationDeg });
  }
  return points;
}

/** Time with the sun in view, hours, of a path with even steps; to a step at each end of an interval. */
export function hoursInView(path: readonly SunPoint[], stepMinutes: number, isFree: (direction: Vec3) => boolean): number {
  let free = 0;
  for (const { azimuthDeg, elevationDeg } of path) if (isFree(directionTo(azimuthDeg, elevationDeg))) ++free;
  return (free * stepMinutes) / 60;
}
