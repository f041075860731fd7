import { isComparison, type Comparison } from './comparison';
import type { FalseColour } from './false_colour';
import { isMode, isPicture, type Mode, type Picture } from './pictures';
import { isLightPart, largestFactor, lightParts, wholeLight, type LightMix } from './light_parts';
import type { Vec3 } from './units';

/** What a link restores. Positions are local world metres, z up. */
export interface ViewState {
  mode: Mode;
  position: Vec3;
  target: Vec3;
  picture: Picture;
  /** Number of an instant; between two of them while they fade. */
  moment: number;
  ev: number;
  /** The air between the eye and the city is drawn. */
  air: boolean;
  /** Parts of the light that are switched off or scaled. */
  mix: LightMix;
  /** Id of the study's layer on show; null in other pictures. */
  layer: string | null;
  /** Range of the false colours; null: as the light suggests. */
  scale: FalseColour | null;
  /** Of two bakes: what is shown of them, and where the divider stands (0…1); null with one bake. */
  comparison: { shown: Comparison; divider: number } | null;
}

const metres = (v: Vec3) => v.map((c) => c.toFixed(2)).join(',');

export function formatViewState(state: ViewState): string {
  const off = state.mix.off.length > 0 ? `&off=${state.mix.off.join(',')}` : '';
  const scaled = lightParts.filter((part) => state.mix.factors[part] !== 1).map((part) => `${part}:${state.mix.factors[part].toFixed(2)}`);
  const factors = scaled.length > 0 ? `&k=${scaled.join(',')}` : '';
  const layer = state.layer === null ? '' : `&l=${state.layer}`;
  const scale = state.scale ? `&fc=${state.scale.low},${state.scale.high},${state.scale.isLogarithmic ? 'log' : 'lin'}` : '';
  const comparison = state.comparison ? `&c=${state.comparison.shown},${state.comparison.divider.toFixed(3)}` : '';
  const instant = Math.round(state.moment);
  const fade = state.moment === instant ? '' : `&f=${(state.moment - instant).toFixed(2)}`; // from the nearest instant, which a still shows
  return `#v=1&m=${state.mode}&p=${metres(state.position)}&t=${metres(state.target)}&s=${state.picture}${layer}&i=${instant}${fade}&ev=${state.ev.toFixed(1)}${state.air ? '' : '&a=0'}${off}${factors}${scale}${comparison}`;
}

/** Reads what it understands and leaves out the rest: an old or hand-written link still opens the city. */
export function parseViewState(hash: string): Partial<ViewState> {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  if (fields.get('v') !== '1') return {};
  const state: Partial<ViewState> = {};
  const mode = fields.get('m');
  if (isMode(mode)) state.mode = mode;
  const picture = fields.get('s');
  if (isPicture(picture)) state.picture = picture;
  const position = parseVec3(fields.get('p'));
  const target = parseVec3(fields.get('t'));
  if (position && target) {
    state.position = position;
    state.target = target;
  }
  const instant = Number(fields.get('i') ?? NaN);
  const fade = Number(fields.get('f') ?? 0);
  if (Number.isInteger(instant) && instant >= 0) state.moment = Math.max(0, instant + (Math.abs(fade) <= 0.5 ? fade : 0));
  const ev = Number(fields.get('ev') ?? NaN);
  if (Number.isFinite(ev)) state.ev = ev;
  const air = fields.get('a');
  if (air === '0' || air === '1') state.air = air === '1';
  const off = fields.get('off');
  const factors = parseFactors(fields.get('k'));
  if (off !== null || factors) state.mix = { off: (off ?? '').split(',').filter(isLightPart), factors: { ...wholeLight.factors, ...factors } };
  const layer = fields.get('l');
  if (layer !== null && /^[a-z0-9_.-]+$/.test(layer)) state.layer = layer;
  const [low, high, kind] = (fields.get('fc') ?? '').split(',');
  const scale = { low: Number(low), high: Number(high), isLogarithmic: kind === 'log' };
  if (high !== undefined && scale.low < scale.high && Number.isFinite(scale.high) && (scale.low > 0 || !scale.isLogarithmic)) state.scale = scale;
  const [shown, divider] = (fields.get('c') ?? '').split(',');
  if (isComparison(shown) && Number(divider) >= 0 && Number(divider) <= 1) state.comparison = { shown, divider: Number(divider) };
  return state;
}

function parseFactors(field: string | null): Partial<LightMix['factors']> | null {
  if (field === null) return null;
  const entries = field.split(',').map((entry) => entry.split(':'));
  return Object.fromEntries(entries.flatMap(([part, factor]) => (isLightPart(part) && Number(factor) >= 0 && Number(factor) <= largestFactor ? [[part, Number(factor)]] : [])));
}

function parseVec3(field: string | null): Vec3 | null {
  const parts = (field ?? '').split(',').map(Number);
  const [x, y, z] = parts;
  if (parts.length !== 3 || x === undefined || y === undefined || z === undefined) return null;
  return parts.every((part) => Number.isFinite(part)) && field !== '' ? [x, y, z] : null;
}
