import * as THREE from 'three';
import { luminance, srgbDecode } from '../core/units';
import type { SurfacePoint } from './city_rays';

/** Luminous reflectance (albedo) of a surface at a place, 0…1, from the very pixel of its texture. */
export function reflectanceAt({ tint, map, uv }: SurfacePoint): number {
  const texel = map && uv ? pixelOf(map, uv) : ([1, 1, 1] as const);
  return luminance([tint.x * texel[0], tint.y * texel[1], tint.z * texel[2]]);
}

function pixelOf(map: THREE.Texture, uv: THREE.Vector2): readonly [number, number, number] {
  const image = map.image as ImageBitmap;
  const wrapped = (at: number, wrapping: THREE.Wrapping): number => {
    if (wrapping === THREE.ClampToEdgeWrapping) return at;
    const turn = at - 2 * Math.floor(at / 2); // 0…2
    return wrapping === THREE.MirroredRepeatWrapping && turn > 1 ? 2 - turn : turn % 1;
  };
  const place = { x: wrapped(uv.x, map.wrapS), y: wrapped(uv.y, map.wrapT) };
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 1;
  const context = canvas.getContext('2d');
  if (!context) return [1, 1, 1];
  const pixel = (at: number, size: number): number => Math.min(size - 1, Math.max(0, Math.floor(at * size)));
  context.drawImage(image, pixel(place.x, image.width), pixel(place.y, image.height), 1, 1, 0, 0, 1, 1);
  const [r, g, b] = context.getImageData(0, 0, 1, 1).data;
  return [srgbDecode((r ?? 0) / 255), srgbDecode((g ?? 0) / 255), srgbDecode((b ?? 0) / 255)];
}
