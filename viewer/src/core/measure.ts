import type { Bake } from './bake';
import { lightParts, type LightPart } from './light_parts';
import { luminance } from './units';

/** The light of a texel as the archive holds it, 32-bit. */
export interface MeasuredLight {
  /** Illuminance with all parts, lx. */
  total: number;
  /** Illuminance of the parts that the bake has, lx. */
  parts: { part: LightPart; lx: number }[];
  skyViewFactor: number;
  /** The texel has no light of its own: it lies buried in another solid, or outside of every chart. */
  isFilled: boolean;
}

const stateOfChart = 1;

/** Reads one texel of an instant. Throws LoadError when the archive is missing or damaged. */
export async function measure(bake: Bake, instant: number, page: number, column: number, row: number): Promise<MeasuredLight> {
  const [light, base] = await Promise.all([bake.lightFile(instant, page), bake.baseFile(page)]);
  const [own, shared] = await Promise.all([light.texel(column, row), base.texel(column, row)]);
  const lux = (from: Map<string, number>, prefix: string): number | null => {
    const [r, g, b] = ['R', 'G', 'B'].map((channel) => from.get(prefix + channel));
    return r === undefined || g === undefined || b === undefined ? null : luminance([r, g, b]);
  };
  const parts = lightParts.flatMap((part) => {
    const lx = lux(part === 'lamps' ? shared : own, `${part}.`); // lamps shine at all instants alike
    return lx === null ? [] : [{ part, lx }];
  });
  return { total: lux(own, '') ?? 0, parts, skyViewFactor: shared.get('sky_view_factor') ?? 0, isFilled: shared.get('state') !== stateOfChart };
}
