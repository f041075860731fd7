/** The three pictures of the paper: the textured city in its light, the textures alone, the light alone on white; measures in false colours; and a study's layers. */
export const pictures = ['lit', 'textures', 'light', 'illuminance', 'sky-view', 'layer'] as const;
export type Picture = (typeof pictures)[number];

export const modes = ['orbit', 'walk'] as const;
export type Mode = (typeof modes)[number];

/** Pictures of numbers: colours of a scale instead of light. */
export function isMeasure(picture: Picture): boolean {
  return picture === 'illuminance' || picture === 'sky-view' || picture === 'layer';
}

/** Pictures that change with the parts of the light. */
export function showsLight(picture: Picture): boolean {
  return picture === 'lit' || picture === 'light' || picture === 'illuminance';
}

export function isPicture(value: unknown): value is Picture {
  return pictures.some((known) => known === value);
}

export function isMode(value: unknown): value is Mode {
  return modes.some((known) => known === value);
}
