/** What the light of a bake is made of; each can be switched off and scaled in the picture. */
export const lightParts = ['sun', 'sky', 'indirect', 'lamps'] as const;
export type LightPart = (typeof lightParts)[number];

/** Factors go from 0 to this. */
export const largestFactor = 2;

/** How much of the parts is shown. A part that is off keeps its factor for when it comes back. */
export interface LightMix {
  readonly off: readonly LightPart[];
  readonly factors: Readonly<Record<LightPart, number>>;
}

/** The light as it was baked. */
export const wholeLight: LightMix = { off: [], factors: { sun: 1, sky: 1, indirect: 1, lamps: 1 } };

export function isLightPart(name: unknown): name is LightPart {
  return (lightParts as readonly unknown[]).includes(name);
}

/** What the part is multiplied with. */
export function factorOf(mix: LightMix, part: LightPart): number {
  return mix.off.includes(part) ? 0 : mix.factors[part];
}

/** Parts of those that a bake has whose light is not shown as it was baked. */
export function changedParts(mix: LightMix, parts: readonly LightPart[] = lightParts): LightPart[] {
  return parts.filter((part) => factorOf(mix, part) !== 1);
}

export function withPartOn(mix: LightMix, part: LightPart, isOn: boolean): LightMix {
  return { ...mix, off: lightParts.filter((other) => (other === part ? !isOn : mix.off.includes(other))) };
}

/** Another factor, in whole percents; it switches the part on. */
export function withFactor(mix: LightMix, part: LightPart, factor: number): LightMix {
  const kept = Math.round(100 * Math.min(largestFactor, Math.max(0, factor))) / 100;
  return withPartOn({ ...mix, factors: { ...mix.factors, [part]: kept } }, part, true);
}
