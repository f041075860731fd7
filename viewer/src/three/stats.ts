import type * as THREE from 'three';
import type { BakedScene } from './baked_scene';

export interface ViewerStats {
  frames: number;
  drawCalls: number;
  triangles: number;
  textures: number;
  geometries: number;
  /** Of city.glb, before joining. */
  primitives: number;
  /** Lightmaps, and albedo textures, on the graphics card. */
  lightBytes: number;
  textureBytes: number;
}

/** What was drawn last, and what is held on the graphics card. */
export function statsOf({ render, memory }: THREE.WebGLInfo, all: readonly BakedScene[], frames: number): ViewerStats {
  const sum = (of: (baked: BakedScene) => number): number => all.reduce((total, baked) => total + of(baked), 0);
  return {
    frames, drawCalls: render.calls, textures: memory.textures, geometries: memory.geometries,
    triangles: sum(({ city }) => city.triangleCount),
    primitives: sum(({ city }) => city.primitiveCount),
    lightBytes: sum(({ lightBytes }) => lightBytes),
    textureBytes: sum(({ city }) => city.textureBytes),
  };
}
