// Colours of a study's layer: flowing or in steps, from one end of the scale to the other or out from zero.
import { differenceColours, placeOf, viridis, type FalseColour } from './false_colour';
import type { Manifest } from './generated/manifest';
import { language } from './text/language';

export type Layer = NonNullable<Manifest['layers']>[number];

/** sRGB codes 0…255. */
export type Code = readonly [number, number, number];

/** Entries of a ramp: four between neighbouring grey levels, so that each level meets an entry of its own. */
export const rampSize = 4 * 255 + 1;

export function titleOf({ title, unit }: Layer, hasUnit = true): string {
  const named = hasUnit && unit !== '1' ? `, ${unitOf(unit)}` : '';
  return `${title[language]}${named}`;
}

/** A value with its unit; differences have a sign. */
export function formatQuantity({ unit, kind, minimum, maximum }: Layer, value: number): string {
  const digits = Math.min(9, Math.max(0, 4 - Math.floor(Math.log10(Math.max(Math.abs(minimum), Math.abs(maximum), 1e-6))))); // finer than a ten-thousandth of the range
  const sign = kind === 'diverging' && value !== 0 ? (value > 0 ? '+' : '−') : value < 0 ? '−' : '';
  return `${sign}${Math.abs(value).toLocaleString(language, { maximumFractionDigits: digits })} ${unitOf(unit)}`.trim();
}

/** As it is printed: kWh/m2 becomes kWh/m². */
export function unitOf(unit: string): string {
  return unit === '1' ? '' : unit.replace(/m2\b/g, 'm²').replace(/m3\b/g, 'm³');
}

/** Where the colours of a layer begin and end: what the page allows to be changed in flowing layers that begin at one end. */
export function scaleOf({ minimum, maximum, kind }: Layer): FalseColour {
  const reach = Math.max(Math.abs(minimum), Math.abs(maximum));
  return kind === 'diverging' ? { low: -reach, high: reach, isLogarithmic: false } : { low: minimum, high: maximum, isLogarithmic: false };
}

/** Bounds of the steps, one more than there are steps; what lies beyond the first or last edge has a step of its own where the layer reaches there. */
export function boundsOf({ edges, minimum, maximum }: Layer): number[] {
  if (!edges) return [minimum, maximum];
  const [first, last] = [edges[0], edges.at(-1) ?? 0];
  return [...(minimum < first ? [minimum] : []), ...edges, ...(maximum > last ? [maximum] : [])];
}

function mixed(colours: readonly Code[], share: number): Code {
  const place = Math.min(1, Math.max(0, share)) * (colours.length - 1);
  const step = Math.min(Math.floor(place), colours.length - 2);
  const at = (c: 0 | 1 | 2): number => (1 - (place - step)) * (colours[step]?.[c] ?? 0) + (place - step) * (colours[step + 1]?.[c] ?? 0);
  return [at(0), at(1), at(2)];
}

/** Colours of the steps, in their order. */
export function stepColours(layer: Layer): Code[] {
  const bounds = boundsOf(layer);
  const count = bounds.length - 1;
  if (layer.kind === 'sequential') return Array.from({ length: count }, (_, k) => mixed(viridis, count === 1 ? 0.5 : k / (count - 1)));
  const below = bounds.slice(1).filter((upper) => upper <= 0).length; // steps that lie below zero as a whole
  const above = bounds.slice(0, -1).filter((lower) => lower >= 0).length;
  const reach = Math.max(1, below, above);
  return Array.from({ length: count }, (_, k) => {
    const rank = k < below ? k - below : k >= count - above ? k - (count - above) + 1 : 0; // …, −2, −1, [0 about zero,] 1, 2, …
    return mixed(differenceColours, 0.5 + rank / (2 * reach));
  });
}

/** The colour of a value; `scale` is the user's range of a flowing layer. */
export function layerColour(layer: Layer, scale: FalseColour, value: number): Code {
  if (layer.edges) {
    const bounds = boundsOf(layer);
    const colours = stepColours(layer);
    const step = bounds.slice(1, -1).filter((bound) => value >= bound).length; // a step holds its lower bound
    return colours[step] ?? [0, 0, 0];
  }
  return mixed(layer.kind === 'diverging' ? differenceColours : viridis, placeOf(scale, value));
}

/** RGBA for grey levels 0…255 of the layer's picture, `rampSize` entries. */
export function rampOf(layer: Layer, scale: FalseColour): Uint8Array<ArrayBuffer> {
  const ramp = new Uint8Array(4 * rampSize);
  for (let i = 0; i < rampSize; ++i) {
    const value = layer.minimum + ((layer.maximum - layer.minimum) * i) / (rampSize - 1);
    ramp.set([...layerColour(layer, scale, value).map(Math.round), 255], 4 * i);
  }
  return ramp;
}
