import type { Picture } from './pictures';

/** Range of the user's correction, stops. */
export const evRange = { min: -4, max: 4, step: 0.1 } as const;

/**
 * Above the manifest's hint, which brings the mean of all white surfaces, shadows and courtyards included, to one half: a picture of
 * albedos about 0.3 in the sun wants more. By eye, on streets and on cities from the air.
 */
const daylightEv = 1;

/** White walls are brighter than a city's mean albedo: the light alone is shown darker, so that sunlit walls keep their shades. By eye. */
const lightAloneEv = -1.2;

/**
 * The factor from radiance in kcd/m² to the tone mapper's input, where 1 is a diffuse white.
 * @param hint the manifest's exposure_hint of the instant, m²/kcd
 * @param ev the user's correction, stops
 */
export function exposureFactor(hint: number, ev: number, picture: Picture): number {
  return hint * 2 ** (ev + daylightEv + (picture === 'light' ? lightAloneEv : 0));
}

export function clampEv(ev: number): number {
  const stepped = Math.round(ev / evRange.step) * evRange.step;
  return Math.min(evRange.max, Math.max(evRange.min, Math.abs(stepped) < 1e-9 ? 0 : stepped));
}
