import * as THREE from 'three';
import { airAxes } from '../core/air';
import type { BakedInstant } from '../core/bake';
import { worldToScene, type Vec3 } from '../core/units';

/** Uniforms of airShader, shared by city and sky: of the instant on show, and of the one that it fades into. */
export interface AirUniforms {
  [name: string]: THREE.IUniform;
  uHasAir: THREE.IUniform<boolean>;
  /** 0: the first instant alone, 1: the second alone. */
  uBlend: THREE.IUniform<number>;
  uMoleculeAirlight: THREE.IUniform<THREE.Texture | null>;
  uHazeAirlight: THREE.IUniform<THREE.Texture | null>;
  uMoleculeAirlightB: THREE.IUniform<THREE.Texture | null>;
  uHazeAirlightB: THREE.IUniform<THREE.Texture | null>;
  uMoleculesPerM: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uHazePerM: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uAirHeights: THREE.IUniform<THREE.Vector2>;
  uAirBase: THREE.IUniform<number>;
  uAirAxes: THREE.IUniform<[THREE.Matrix3, THREE.Matrix3]>;
}

export function makeAirUniforms(): AirUniforms {
  return {
    uHasAir: { value: false },
    uBlend: { value: 0 },
    uMoleculeAirlight: { value: null },
    uHazeAirlight: { value: null },
    uMoleculeAirlightB: { value: null },
    uHazeAirlightB: { value: null },
    uMoleculesPerM: { value: [new THREE.Vector3(), new THREE.Vector3()] },
    uHazePerM: { value: [new THREE.Vector3(), new THREE.Vector3()] },
    uAirHeights: { value: new THREE.Vector2(1, 1) },
    uAirBase: { value: 0 },
    uAirAxes: { value: [new THREE.Matrix3(), new THREE.Matrix3()] },
  };
}

/** The air of an instant, as the one on show (0) or the one that it fades into (1). */
export function applyAir(uniforms: AirUniforms, slot: 0 | 1, air: NonNullable<BakedInstant['air']>, sun: Vec3, textures: { molecules: THREE.Texture; haze: THREE.Texture }): void {
  (slot === 0 ? uniforms.uMoleculeAirlight : uniforms.uMoleculeAirlightB).value = textures.molecules;
  (slot === 0 ? uniforms.uHazeAirlight : uniforms.uHazeAirlightB).value = textures.haze;
  uniforms.uMoleculesPerM.value[slot].fromArray(air.molecules_per_m);
  uniforms.uHazePerM.value[slot].fromArray(air.haze_per_m);
  uniforms.uAirHeights.value.set(air.molecule_height_m, air.haze_height_m);
  uniforms.uAirBase.value = air.base_m;
  const { a, b } = airAxes(sun);
  uniforms.uAirAxes.value[slot].set(...worldToScene(a), ...worldToScene(b), ...worldToScene(sun));
}

/**
 * What is left of a radiance seen through the air, and what the air adds (docs/physics.md, "Aerial perspective"): four pieces of the path,
 * in each of which molecules and haze keep their proportion. The same as view_through of src/sky/aerial_perspective.cpp.
 */
export const airShader = /* glsl */ `
uniform bool uHasAir;
uniform sampler2D uMoleculeAirlight;
uniform sampler2D uHazeAirlight;
uniform sampler2D uMoleculeAirlightB;
uniform sampler2D uHazeAirlightB;
uniform vec3 uMoleculesPerM[2];
uniform vec3 uHazePerM[2];
uniform vec2 uAirHeights;
uniform float uAirBase;
uniform mat3 uAirAxes[2];
uniform float uBlend;

// Integral of exp(-h / H) over a piece of the path, for both scale heights.
vec2 airColumn(float begin, float end, float metres) {
  vec2 rise = (end - begin) / uAirHeights;
  vec2 series = 1.0 - rise * (0.5 - rise / 6.0); // below 0.02 the difference of exponentials loses its digits
  vec2 mean = mix((1.0 - exp(-rise)) / rise, series, lessThan(abs(rise), vec2(0.02)));
  return exp(-begin / uAirHeights) * mean * metres;
}

vec3 throughAirOf(sampler2D moleculeTable, sampler2D hazeTable, mat3 axes, vec3 moleculesPerM, vec3 hazePerM, vec3 radiance, vec3 direction, float metres) {
  vec3 about = axes * direction;
  float angle = atan(length(about.xy), about.z);
  float rows = float(textureSize(hazeTable, 0).y);
  vec2 place = vec2(atan(about.y, about.x) / 6.283185307, (sqrt(angle / 3.141592654) * (rows - 1.0) + 0.5) / rows);
  vec3 moleculeAirlight = textureLod(moleculeTable, place, 0.0).rgb;
  vec3 hazeAirlight = textureLod(hazeTable, place, 0.0).rgb;
  float begin = cameraPosition.y - uAirBase;
  float piece = 0.25 * metres;
  vec3 transmittance = vec3(1.0);
  vec3 inscatter = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    float end = begin + piece * direction.y;
    vec2 column = airColumn(begin, end, piece);
    vec3 molecules = moleculesPerM * column.x;
    vec3 haze = hazePerM * column.y;
    vec3 depth = max(molecules + haze, 1e-12);
    vec3 after = transmittance * exp(-depth);
    inscatter += (moleculeAirlight * molecules + hazeAirlight * haze) / depth * (transmittance - after);
    transmittance = after;
    begin = end;
  }
  return radiance * transmittance + inscatter;
}

vec3 throughAir(vec3 radiance, vec3 direction, float metres) {
  if (!uHasAir) return radiance;
  vec3 seen = throughAirOf(uMoleculeAirlight, uHazeAirlight, uAirAxes[0], uMoleculesPerM[0], uHazePerM[0], radiance, direction, metres);
  if (uBlend == 0.0) return seen;
  return mix(seen, throughAirOf(uMoleculeAirlightB, uHazeAirlightB, uAirAxes[1], uMoleculesPerM[1], uHazePerM[1], radiance, direction, metres), uBlend);
}
`;
