// What the page says about the light of an instant.
import type { BakedInstant } from '../core/bake';
import { text } from '../core/text';
import { luminance } from '../core/units';

/** Koschmieder's sight: where a contrast of one fiftieth is left. */
export function airNote({ air }: BakedInstant): string | null {
  if (!air) return null;
  const green = (air.molecules_per_m[1] ?? 0) + (air.haze_per_m[1] ?? 0);
  return text.airNote(air.turbidity, Math.log(50) / green / 1000);
}

/** @param convergenceDeg azimuth of grid north, clockwise from true north */
export function sunNote({ sun }: BakedInstant, convergenceDeg: number): string {
  const azimuth = (sun.azimuth_deg + convergenceDeg + 720) % 360;
  return sun.shape === 'none' ? text.noSun : text.sun(azimuth, sun.elevation_deg, luminance(sun.normal_illuminance_klx));
}
