import * as THREE from 'three';
import { viridis, type FalseColour } from '../core/false_colour';
import { lightParts, type LightPart } from '../core/light_parts';
import type { Picture } from '../core/pictures';
import { airShader, makeAirUniforms, type AirUniforms } from './air';

const pictureNumber: Record<Picture, number> = { lit: 0, textures: 1, light: 2, illuminance: 3, 'sky-view': 4 };
/** Not for eyes: lux and distance, as differences need them. */
const numbersPicture = 5;
/** From this number on a picture shows a measure in false colours. */
export const firstMeasure = pictureNumber.illuminance;

/** Charts in a row of the texture of scales. */
export const scalesWidth = 2048;

/** Uniforms that all materials share by reference: a change is seen by all of them at the next frame. */
export interface SharedUniforms extends AirUniforms {
  uScales: THREE.IUniform<THREE.Texture | null>;
  uScalesB: THREE.IUniform<THREE.Texture | null>;
  /** Lightmap pages as layers: skylight, and in alpha the sun's cosine; B: of the instant that the one on show fades into. */
  uLight: THREE.IUniform<THREE.Texture | null>;
  uLightB: THREE.IUniform<THREE.Texture | null>;
  uIndirect: THREE.IUniform<THREE.Texture | null>;
  uIndirectB: THREE.IUniform<THREE.Texture | null>;
  uLamps: THREE.IUniform<THREE.Texture | null>;
  uSkyView: THREE.IUniform<THREE.Texture | null>;
  /** Texels of a layer. */
  uPageSize: THREE.IUniform<THREE.Vector2>;
  uSunKlx: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uExposure: THREE.IUniform<number>;
  uPicture: THREE.IUniform<number>;
  /** False colours: low, high, and 1 for a logarithmic scale. */
  uScale: THREE.IUniform<THREE.Vector3>;
  /** Factors for the light of sun, sky, reflections and lamps. */
  uParts: THREE.IUniform<THREE.Vector4>;
}

export function makeSharedUniforms(): SharedUniforms {
  return {
    uScales: { value: null },
    uScalesB: { value: null },
    uLight: { value: null },
    uLightB: { value: null },
    uIndirect: { value: null },
    uIndirectB: { value: null },
    uLamps: { value: null },
    uSkyView: { value: null },
    uPageSize: { value: new THREE.Vector2(1, 1) },
    uSunKlx: { value: [new THREE.Vector3(), new THREE.Vector3()] },
    uScale: { value: new THREE.Vector3(0, 1, 0) },
    uExposure: { value: 1 },
    uPicture: { value: 0 },
    ...makeAirUniforms(),
    uParts: { value: new THREE.Vector4(1, 1, 1, 1) },
  };
}

export function setPicture(uniforms: SharedUniforms, picture: Picture): void {
  uniforms.uPicture.value = pictureNumber[picture];
}

export function setNumbersPicture(uniforms: SharedUniforms): void {
  uniforms.uPicture.value = numbersPicture;
}

export function setFalseColour(uniforms: SharedUniforms, { low, high, isLogarithmic }: FalseColour): void {
  uniforms.uScale.value.set(low, high, isLogarithmic ? 1 : 0);
}

export function setPartsOff(uniforms: SharedUniforms, off: readonly LightPart[]): void {
  uniforms.uParts.value.fromArray(lightParts.map((part) => (off.includes(part) ? 0 : 1)));
}

/**
 * The end of both shaders, city and sky: exposure, tone mapping once, sRGB, and half a step of dither so that smooth skies and walls show
 * no bands. toneMapping() and linearToOutputTexel() come from three for ShaderMaterials that are tone mapped.
 */
export const displayShader = /* glsl */ `
uniform float uExposure;

// Interleaved gradient noise (Jimenez 2014, "Next generation post processing in Call of Duty", slide 123), 0…1.
float ditherNoise(vec2 pixel) {
  return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}

vec4 toDisplay(vec3 radiance) {
  vec3 color = radiance * uExposure;
  #ifdef TONE_MAPPING
    color = toneMapping(color);
  #endif
  vec4 encoded = linearToOutputTexel(vec4(clamp(color, 0.0, 1.0), 1.0));
  return vec4(encoded.rgb + (ditherNoise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}
`;

const vertexShader = /* glsl */ `
in vec3 texel; // column, row, page of the lightmap
in float chart;
in vec4 tint;
#ifdef USE_MAP
in float layer;
flat out float vLayer;
#endif
uniform highp sampler2D uScales;
uniform highp sampler2D uScalesB;
uniform float uBlend;
out vec2 vUv;
centroid out vec2 vTexel;
flat out float vPage;
flat out vec4 vScale;
flat out vec4 vScaleB;
out vec3 vPosition;
flat out vec4 vTint;

void main() {
  vUv = uv;
  #ifdef USE_MAP
    vLayer = layer;
  #endif
  vTint = tint;
  vTexel = texel.xy;
  vPage = texel.z;
  int row = int(chart + 0.5);
  ivec2 entry = ivec2(row % ${scalesWidth}, row / ${scalesWidth});
  vScale = texelFetch(uScales, entry, 0);
  vScaleB = uBlend > 0.0 ? texelFetch(uScalesB, entry, 0) : vec4(0.0);
  vPosition = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

// E [klx] = sky page (sRGB decoded by the hardware, before it filters) × the chart's sky scale
//         + sun page × the chart's sun scale × the beam's normal illuminance
//         + indirect page (likewise) × the chart's indirect scale + lamps' page × the chart's lamp scale;  L [kcd/m²] = albedo/π × E.
// The gutter about a chart is two texels wide: level 1 is the last one whose bilinear footprint stays inside it, and the cubic's four texels
// just do on the chart's border.
const fragmentShader = /* glsl */ `
in vec2 vUv;
centroid in vec2 vTexel;
flat in float vPage;
flat in vec4 vScale;
flat in vec4 vScaleB;
in vec3 vPosition;
flat in vec4 vTint;
uniform sampler2DArray uLight;
uniform sampler2DArray uLightB;
uniform sampler2DArray uIndirect;
uniform sampler2DArray uIndirectB;
uniform sampler2DArray uSkyView;
uniform sampler2DArray uLamps;
uniform vec4 uParts;
uniform vec2 uPageSize;
uniform vec3 uSunKlx[2];
uniform vec3 uScale;
uniform int uPicture;
#ifdef USE_MAP
uniform sampler2DArray uMap;
flat in float vLayer;
#endif
layout(location = 0) out vec4 outColor;
${displayShader}
${airShader}

const vec3 kViridis[${viridis.length}] = vec3[](${viridis.map((code) => `vec3(${code.map((c) => (c / 255).toFixed(6)).join(', ')})`).join(', ')});

// Codes of sRGB, as the legend has them.
vec4 falseColour(float value) {
  float place = uScale.z > 0.5 ? (value > 0.0 ? log(value / uScale.x) / log(uScale.y / uScale.x) : 0.0) : (value - uScale.x) / (uScale.y - uScale.x);
  place = clamp(place, 0.0, 1.0) * ${(viridis.length - 1).toFixed(1)};
  int lower = min(int(place), ${viridis.length - 2});
  return vec4(mix(kViridis[lower], kViridis[lower + 1], place - float(lower)), 1.0);
}

float level; // of the pages

vec4 pageAt(sampler2DArray pages) {
  return textureLod(pages, vec3(vTexel / uPageSize, vPage), level);
}

// Sun, sky and reflected light of one instant, klx.
vec3 lightOf(sampler2DArray light, sampler2DArray indirect, vec4 scale, vec3 beam) {
  vec4 direct = pageAt(light);
  vec3 sum = uParts.x * direct.a * scale.y * beam + uParts.y * direct.rgb * scale.x;
  return scale.z > 0.0 ? sum + uParts.z * scale.z * pageAt(indirect).rgb : sum;
}

void main() {
  vec3 albedo = vTint.rgb;
  #ifdef USE_MAP
    vec4 texel = texture(uMap, vec3(vUv, vLayer));
    albedo *= texel.rgb;
    #ifdef USE_ALPHA_CUTOFF
      if (texel.a * vTint.a < 0.5) discard;
    #endif
  #endif
  if (uPicture == ${pictureNumber.textures}) {
    outColor = linearToOutputTexel(vec4(albedo, 1.0));
    return;
  }
  if (uPicture == ${pictureNumber.light}) albedo = vec3(1.0);
  vec2 dx = dFdx(vTexel);
  vec2 dy = dFdy(vTexel);
  level = clamp(0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-8)), 0.0, 1.0);
  if (uPicture == ${pictureNumber['sky-view']}) {
    outColor = falseColour(pageAt(uSkyView).r);
    return;
  }
  vec3 illuminance = lightOf(uLight, uIndirect, vScale, uSunKlx[0]);
  if (uBlend > 0.0) illuminance = mix(illuminance, lightOf(uLightB, uIndirectB, vScaleB, uSunKlx[1]), uBlend);
  if (vScale.w > 0.0) illuminance += uParts.w * pageAt(uLamps).rgb * vScale.w;
  if (uPicture == ${numbersPicture}) {
    outColor = vec4(1000.0 * dot(illuminance, vec3(0.2126, 0.7152, 0.0722)), length(vPosition - cameraPosition), 0.0, 1.0);
    return;
  }
  if (uPicture == ${pictureNumber.illuminance}) {
    outColor = falseColour(1000.0 * dot(illuminance, vec3(0.2126, 0.7152, 0.0722)));
    return;
  }
  vec3 radiance = albedo * illuminance * RECIPROCAL_PI;
  if (uPicture == ${pictureNumber.lit}) { // light alone is for comparing walls, near and far
    vec3 ray = vPosition - cameraPosition;
    float metres = length(ray);
    radiance = throughAir(radiance, ray / max(metres, 1e-6), metres);
  }
  outColor = toDisplay(radiance);
}
`;

/** A material for surfaces whose textures are layers of `map`; null: for surfaces without textures. */
export function makeCityMaterial(map: THREE.Texture | null, isCutOut: boolean, isDoubleSided: boolean, shared: SharedUniforms): THREE.ShaderMaterial {
  const defines: Record<string, string> = {};
  // RECIPROCAL_PI and toneMapping need <common>-style definitions that three prepends only in part.
  defines['RECIPROCAL_PI'] = '0.3183098861837907';
  if (map) defines['USE_MAP'] = '';
  if (map && isCutOut) defines['USE_ALPHA_CUTOFF'] = '';
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines,
    uniforms: { ...shared, uMap: { value: map } },
    vertexShader,
    fragmentShader,
    side: isDoubleSided ? THREE.DoubleSide : THREE.FrontSide,
  });
}
