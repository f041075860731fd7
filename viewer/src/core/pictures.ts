/** The three pictures of the paper: the textured city in its light, the textures alone, the light alone on white. */
export const pictures = ['lit', 'textures', 'light'] as const;
export type Picture = (typeof pictures)[number];

export const modes = ['orbit', 'walk'] as const;
export type Mode = (typeof modes)[number];

export function isPicture(value: unknown): value is Picture {
  return pictures.some((known) => known === value);
}

export function isMode(value: unknown): value is Mode {
  return modes.some((known) => known === value);
}
