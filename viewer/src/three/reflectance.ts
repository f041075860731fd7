import * as THREE from 'three';
import { luminance, srgbDecode } from '../core/units';
import type { SurfacePoint } from './city_rays';

/** Luminous reflectance (albedo) of a surface at a place, 0…1, from the very pixel of its texture. */
export function reflectanceAt({ mesh, uv }: SurfacePoint): number {
  const { uniforms } = mesh.material;
  const base = uniforms['uBaseColor']?.value as THREE.Color;
  const map = uniforms['uMap']?.value as THREE.Texture | null;
  const texel = map && uv ? pixelOf(map, uv) : ([1, 1, 1] as const);
  return luminance([base.r * texel[0], base.g * texel[1], base.b * texel[2]]);
}

function pixelOf(map: THREE.Texture, uv: THREE.Vector2): readonly [number, number, number] {
  const image = map.image as ImageBitmap;
  const place = map.transformUv(uv.clone()); // wraps as the texture does
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 1;
  const context = canvas.getContext('2d');
  if (!context) return [1, 1, 1];
  const pixel = (at: number, size: number): number => Math.min(size - 1, Math.max(0, Math.floor(at * size)));
  context.drawImage(image, pixel(place.x, image.width), pixel(place.y, image.height), 1, 1, 0, 0, 1, 1);
  const [r, g, b] = context.getImageData(0, 0, 1, 1).data;
  return [srgbDecode((r ?? 0) / 255), srgbDecode((g ?? 0) / 255), srgbDecode((b ?? 0) / 255)];
}
