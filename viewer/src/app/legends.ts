// Which scale belongs to the picture on show.
import type { Bake } from '../core/bake';
import { colourOf, differenceColours, placeOf, ticksOf, type FalseColour } from '../core/false_colour';
import { boundsOf, layerColour, stepColours, titleOf, type Code, type Layer } from '../core/layer_colours';
import { changedParts, factorOf, type LightMix, type LightPart } from '../core/light_parts';
import type { Picture } from '../core/pictures';
import { text } from '../core/text';
import { language } from '../core/text/language';
import type { LegendContent } from '../ui/legend';

const stops = 64;

const plain = (value: number): string => new Intl.NumberFormat(language, { maximumSignificantDigits: 6 }).format(value).replace('-', '−');
const css = (code: Code): string => `rgb(${code.map((c) => c.toFixed(1)).join(' ')})`;

/** What is to be said where light was scaled or switched off; null where the picture shows all of it. */
export function mixWarning(mix: LightMix, parts: readonly LightPart[]): string | null {
  const changed = changedParts(mix, parts);
  return changed.length === 0 ? null : text.mixWarning(changed.map((part) => `${text.partNames[part]} ${text.percent(factorOf(mix, part))}`).join(', '));
}

function flowing(title: string, scale: FalseColour, colour: (value: number) => Code, isFixed = false): LegendContent {
  const colours = Array.from({ length: stops + 1 }, (_, i) => {
    const share = i / stops;
    const value = scale.isLogarithmic ? scale.low * (scale.high / scale.low) ** share : scale.low + share * (scale.high - scale.low);
    return `${css(colour(value))} ${(100 * share).toFixed(2)}%`;
  });
  return {
    title,
    background: `linear-gradient(to right, ${colours.join(', ')})`,
    ticks: ticksOf(scale).map((value) => ({ place: placeOf(scale, value), label: plain(value) })),
    scale: isFixed ? null : scale,
    warning: null,
    note: '',
  };
}

/** Steps of one width each, named at their bounds. */
function stepped(layer: Layer): LegendContent {
  const bounds = boundsOf(layer);
  const count = bounds.length - 1;
  const blocks = stepColours(layer).map((code, k) => `${css(code)} ${((100 * k) / count).toFixed(2)}% ${((100 * (k + 1)) / count).toFixed(2)}%`);
  const every = Math.ceil(bounds.length / 9); // more would touch each other
  return {
    title: titleOf(layer),
    background: `linear-gradient(to right, ${blocks.join(', ')})`,
    ticks: bounds.flatMap((bound, k) => (k % every === 0 ? [{ place: k / count, label: plain(bound) }] : [])),
    scale: null,
    warning: null,
    note: text.legendSteps,
  };
}

/** The scale of a difference: from −range over 0 to +range. */
export function differenceLegend(rangeLx: number, mix: LightMix, parts: readonly LightPart[]): LegendContent {
  const scale = { low: -rangeLx, high: rangeLx, isLogarithmic: false };
  return {
    ...flowing(text.compare.legend, scale, () => [0, 0, 0], true),
    background: `linear-gradient(to right, ${differenceColours.map((code) => `rgb(${code.join(' ')})`).join(', ')})`,
    warning: mixWarning(mix, parts),
    note: text.compare.legendNote,
  };
}

/** Null for pictures of light. */
export function legendOf(bake: Bake, state: { picture: Picture; scale: FalseColour; layer: string | null; mix: LightMix; parts: readonly LightPart[] }): LegendContent | null {
  const { picture, scale, mix, parts } = state;
  const viridis = (value: number): Code => colourOf(scale, value);
  if (picture === 'illuminance') return { ...flowing(text.legendTitle.illuminance, scale, viridis), warning: mixWarning(mix, parts) };
  if (picture === 'sky-view') return flowing(text.legendTitle['sky-view'], scale, viridis);
  const layer = picture === 'layer' ? bake.layer(state.layer) : null;
  if (!layer) return null;
  return layer.edges ? stepped(layer) : flowing(titleOf(layer), scale, (value) => layerColour(layer, scale, value), layer.kind === 'diverging');
}
