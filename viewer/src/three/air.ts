import * as THREE from 'three';
import { airAxes } from '../core/air';
import type { BakedInstant } from '../core/bake';
import { worldToScene, type Vec3 } from '../core/units';

/** Uniforms of airShader, shared by city and sky. */
export interface AirUniforms {
  [name: string]: THREE.IUniform;
  uHasAir: THREE.IUniform<boolean>;
  uMoleculeAirlight: THREE.IUniform<THREE.Texture | null>;
  uHazeAirlight: THREE.IUniform<THREE.Texture | null>;
  uMoleculesPerM: THREE.IUniform<THREE.Vector3>;
  uHazePerM: THREE.IUniform<THREE.Vector3>;
  uAirHeights: THREE.IUniform<THREE.Vector2>;
  uAirBase: THREE.IUniform<number>;
  uAirAxes: THREE.IUniform<THREE.Matrix3>;
}

export function makeAirUniforms(): AirUniforms {
  return {
    uHasAir: { value: false },
    uMoleculeAirlight: { value: null },
    uHazeAirlight: { value: null },
    uMoleculesPerM: { value: new THREE.Vector3() },
    uHazePerM: { value: new THREE.Vector3() },
    uAirHeights: { value: new THREE.Vector2(1, 1) },
    uAirBase: { value: 0 },
    uAirAxes: { value: new THREE.Matrix3() },
  };
}

/** The air of an instant; the base is where level land lies, with or without air. */
export function applyAir(uniforms: AirUniforms, air: NonNullable<BakedInstant['air']>, sun: Vec3, textures: { molecules: THREE.Texture; haze: THREE.Texture }): void {
  uniforms.uMoleculeAirlight.value = textures.molecules;
  uniforms.uHazeAirlight.value = textures.haze;
  uniforms.uMoleculesPerM.value.fromArray(air.molecules_per_m);
  uniforms.uHazePerM.value.fromArray(air.haze_per_m);
  uniforms.uAirHeights.value.set(air.molecule_height_m, air.haze_height_m);
  uniforms.uAirBase.value = air.base_m;
  const { a, b } = airAxes(sun);
  uniforms.uAirAxes.value.set(...worldToScene(a), ...worldToScene(b), ...worldToScene(sun));
}

/**
 * What is left of a radiance seen through the air, and what the air adds (docs/physics.md, "Aerial perspective"): four pieces of the path,
 * in each of which molecules and haze keep their proportion. The same as view_through of src/sky/aerial_perspective.cpp.
 */
export const airShader = /* glsl */ `
uniform bool uHasAir;
uniform sampler2D uMoleculeAirlight;
uniform sampler2D uHazeAirlight;
uniform vec3 uMoleculesPerM;
uniform vec3 uHazePerM;
uniform vec2 uAirHeights;
uniform float uAirBase;
uniform mat3 uAirAxes;

// Integral of exp(-h / H) over a piece of the path, for both scale heights.
vec2 airColumn(float begin, float end, float metres) {
  vec2 rise = (end - begin) / uAirHeights;
  vec2 series = 1.0 - rise * (0.5 - rise / 6.0); // below 0.02 the difference of exponentials loses its digits
  vec2 mean = mix((1.0 - exp(-rise)) / rise, series, lessThan(abs(rise), vec2(0.02)));
  return exp(-begin / uAirHeights) * mean * metres;
}

vec3 throughAir(vec3 radiance, vec3 direction, float metres) {
  if (!uHasAir) return radiance;
  vec3 about = uAirAxes * direction;
  float angle = atan(length(about.xy), about.z);
  float rows = float(textureSize(uHazeAirlight, 0).y);
  vec2 place = vec2(atan(about.y, about.x) / 6.283185307, (sqrt(angle / 3.141592654) * (rows - 1.0) + 0.5) / rows);
  vec3 moleculeAirlight = textureLod(uMoleculeAirlight, place, 0.0).rgb;
  vec3 hazeAirlight = textureLod(uHazeAirlight, place, 0.0).rgb;
  float begin = cameraPosition.y - uAirBase;
  float piece = 0.25 * metres;
  vec3 transmittance = vec3(1.0);
  vec3 inscatter = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    float end = begin + piece * direction.y;
    vec2 column = airColumn(begin, end, piece);
    vec3 molecules = uMoleculesPerM * column.x;
    vec3 haze = uHazePerM * column.y;
    vec3 depth = max(molecules + haze, 1e-12);
    vec3 after = transmittance * exp(-depth);
    inscatter += (moleculeAirlight * molecules + hazeAirlight * haze) / depth * (transmittance - after);
    transmittance = after;
    begin = end;
  }
  return radiance * transmittance + inscatter;
}
`;
