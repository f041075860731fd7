// Numbers as colours: the same scale as src/render/false_colour.cpp (tests/render/false_colour_values.csv holds both to the same numbers).
// Colours: viridis (S. van der Walt, N. Smith, 2015).

export interface FalseColour {
  low: number;
  /** Above low. */
  high: number;
  /** Then low is positive. */
  isLogarithmic: boolean;
}

/** Nine even steps of the map, sRGB codes; between them colours are mixed as codes. */
export const viridis: readonly (readonly [number, number, number])[] = [
  [68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98], [173, 220, 48], [253, 231, 37],
];

/** Codes of the colours of a difference: darker, equal, brighter. Blue and orange are told apart by all eyes. */
export const differenceColours: readonly (readonly [number, number, number])[] = [[20, 80, 190], [245, 245, 245], [200, 70, 10]];

export function placeOf(scale: FalseColour, value: number): number {
  if (!scale.isLogarithmic) return (value - scale.low) / (scale.high - scale.low);
  return value > 0 ? Math.log(value / scale.low) / Math.log(scale.high / scale.low) : 0;
}

/** sRGB codes 0…255, not rounded. */
export function colourOf(scale: FalseColour, value: number): [number, number, number] {
  const place = Math.min(1, Math.max(0, placeOf(scale, value))) * (viridis.length - 1);
  const step = Math.min(Math.floor(place), viridis.length - 2);
  const mix = (c: 0 | 1 | 2): number => (1 - (place - step)) * (viridis[step]?.[c] ?? 0) + (place - step) * (viridis[step + 1]?.[c] ?? 0);
  return [mix(0), mix(1), mix(2)];
}

/** The step of 1, 2 or 5 times a power of ten that cuts `range` into about five. */
export function roundStep(range: number): number {
  const rough = range / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const lead = rough / power;
  return (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10) * power;
}

/** Round values for the legend, from low to high. */
export function ticksOf(scale: FalseColour): number[] {
  const ticks: number[] = [];
  const slack = 1e-9;
  if (!scale.isLogarithmic) {
    const step = roundStep(scale.high - scale.low);
    for (let i = Math.ceil(scale.low / step - slack); i * step <= scale.high + slack * step; ++i) ticks.push(Number((i * step).toPrecision(12)));
    return ticks;
  }
  const decades = Math.log10(scale.high / scale.low);
  for (let power = Math.floor(Math.log10(scale.low)); power <= Math.log10(scale.high); ++power) {
    for (const lead of decades > 2.5 ? [1] : [1, 2, 5]) {
      const value = Number((lead * 10 ** power).toPrecision(12));
      if (value >= scale.low * (1 - slack) && value <= scale.high * (1 + slack)) ticks.push(value);
    }
  }
  return ticks;
}

export const skyViewScale: FalseColour = { low: 0, high: 1, isLogarithmic: false };

/**
 * A range of lux for the light of an instant: two decades that end at 1, 2 or 5 times a power of ten, above the beam on a surface that faces it with a tenth for the
 * sky, and above the mean of all surfaces with a third.
 * @param hint the manifest's exposure_hint: 0.5 over the mean luminance of white surfaces, m²/kcd
 * @param beamKlx illuminance by the sun alone of a surface that faces it
 */
export function autoScale(hint: number, beamKlx: number): FalseColour {
  const wanted = 1000 * Math.max(1.1 * beamKlx, 1.3 * ((Math.PI * 0.5) / hint));
  const power = 10 ** Math.floor(Math.log10(wanted));
  const high = Number((([1, 2, 5, 10].find((lead) => lead * power >= wanted * (1 - 1e-9)) ?? 10) * power).toPrecision(3));
  return { low: Number((high / 100).toPrecision(3)), high, isLogarithmic: true };
}
