// Numbers and frames. World: x = grid east, y = grid north, z up, metres. Scene (glTF, three.js): x = east, y = up, z = −north.

export type Vec3 = readonly [number, number, number];

export function worldToScene([x, y, z]: Vec3): [number, number, number] {
  return [x, z, -y];
}

export function sceneToWorld([x, y, z]: Vec3): [number, number, number] {
  return [x, -z, y];
}

/** Luminance (or illuminance) of Rec. 709 photometric RGB. */
export function luminance([r, g, b]: Vec3): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** IEC 61966-2-1: linear 0…1 to encoded 0…1. */
export function srgbEncode(linear: number): number {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
}

/** IEC 61966-2-1: encoded 0…1 to linear 0…1. */
export function srgbDecode(encoded: number): number {
  return encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4;
}

/** The number that an IEEE 754 binary16 holds. */
export function halfToNumber(bits: number): number {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 0x1f;
  const mantissa = bits & 0x3ff;
  if (exponent === 0) return sign * mantissa * 2 ** -24;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
}
