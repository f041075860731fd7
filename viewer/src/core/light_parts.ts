/** What the light of a bake is made of; each can be switched off in the picture. */
export const lightParts = ['sun', 'sky', 'indirect', 'lamps'] as const;
export type LightPart = (typeof lightParts)[number];

export function isLightPart(name: unknown): name is LightPart {
  return (lightParts as readonly unknown[]).includes(name);
}
