// Vectors and rectangles that the synthetic bake is made of.
export type V3 = [number, number, number];

export const add = (a: V3, b: V3, scale = 1): V3 => [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]];
export const dot = (a: V3, b: V3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: V3): number => Math.sqrt(dot(a, a));

/** A rectangle: corner, two edges, outward normal. `light` overrides what would be computed. */
export interface Face { corner: V3; u: V3; v: V3; normal: V3; material: number; light?: { sky: V3; sunCosine: number } }

/** A face in the atlas: its page, and the texels that it covers there. */
export interface Chart { face: Face; page: number; x: number; y: number; columns: number; rows: number }
