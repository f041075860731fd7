import * as THREE from 'three';
import { viridis, type FalseColour } from '../core/false_colour';
import { factorOf, lightParts, type LightMix } from '../core/light_parts';
import type { Picture } from '../core/pictures';
import { airShader, makeAirUniforms, type AirUniforms } from './air';

const pictureNumber: Record<Picture, number> = { lit: 0, textures: 1, light: 2, illuminance: 3, 'sky-view': 4, layer: 5 };
/** Not for eyes: lux and distance, as differences need them. */
export const numbersPicture = 6;
/** From this number on a picture shows a measure in false colours. */
export const firstMeasure = pictureNumber.illuminance;

/** Layers that the shader can tell apart; graphics cards have 256 to 2,048. */
export const mostPages = 2048;
/** What a surface shows until its page is here, as a share of its chart's brightest light: a city without shadows, neither black nor blinding. */
const untilLoaded = 0.6;

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
  uMeasure: THREE.IUniform<THREE.Texture | null>;
  /** A bit a page of the instant on show that is here. */
  uPagesHere: THREE.IUniform<Int32Array>;
  /** Texels of a layer. */
  uPageSize: THREE.IUniform<THREE.Vector2>;
  uSunKlx: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uExposure: THREE.IUniform<number>;
  uPicture: THREE.IUniform<number>;
  /** False colours: low, high, and 1 for a logarithmic scale. */
  uScale: THREE.IUniform<THREE.Vector3>;
  /** Factors for the light of sun, sky, reflections and lamps. */
  uParts: THREE.IUniform<THREE.Vector4>;
  /** Colours of a study's layer, by its grey level. */
  uRamp: THREE.IUniform<THREE.Texture | null>;
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
    uMeasure: { value: null },
    uPagesHere: { value: new Int32Array(mostPages / 32) },
    uPageSize: { value: new THREE.Vector2(1, 1) },
    uSunKlx: { value: [new THREE.Vector3(), new THREE.Vector3()] },
    uScale: { value: new THREE.Vector3(0, 1, 0) },
    uExposure: { value: 1 },
    uPicture: { value: 0 },
    ...makeAirUniforms(),
    uParts: { value: new THREE.Vector4(1, 1, 1, 1) },
    uRamp: { value: null },
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

export function setParts(uniforms: SharedUniforms, mix: LightMix): void {
  uniforms.uParts.value.fromArray(lightParts.map((part) => factorOf(mix, part)));
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
uniform int uPagesHere[${mostPages / 32}];
flat out int vIsHere;
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
  int page = int(texel.z + 0.5);
  vIsHere = (uPagesHere[page >> 5] >> (page & 31)) & 1;
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
flat in int vIsHere;
flat in vec4 vScale;
flat in vec4 vScaleB;
in vec3 vPosition;
flat in vec4 vTint;
uniform sampler2DArray uLight;
uniform sampler2DArray uLightB;
uniform sampler2DArray uIndirect;
uniform sampler2DArray uIndirectB;
uniform sampler2DArray uMeasure;
uniform sampler2D uRamp;
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
vec4 cubicPlaces; // left, upper, right, lower: where two texels each are read at once
vec2 cubicShares; // of right and lower

// A cubic B-spline over 4 × 4 texels as four bilinear reads: C. Sigg, M. Hadwiger, "Fast third-order texture filtering", GPU Gems 2 (2005),
// ch. 20. Twin: src/render/light_page.cpp.
void placeCubic() {
  vec2 first = floor(vTexel - 0.5);
  vec2 t = vTexel - 0.5 - first;
  vec2 s = 1.0 - t;
  vec2 w0 = s * s * s / 6.0;
  vec2 w1 = 2.0 / 3.0 - 0.5 * t * t * (2.0 - t);
  vec2 w2 = 2.0 / 3.0 - 0.5 * s * s * (2.0 - s);
  vec2 w3 = t * t * t / 6.0;
  cubicShares = w2 + w3;
  cubicPlaces = vec4(first - 0.5 + w1 / (w0 + w1), first + 1.5 + w3 / cubicShares) / uPageSize.xyxy;
}

// Where a pixel is wider than a texel the coarser level is mixed in, and is all from two texels on.
vec4 pageAt(sampler2DArray pages) {
  if (level >= 1.0) return textureLod(pages, vec3(vTexel / uPageSize, vPage), 1.0);
  vec4 upper = mix(textureLod(pages, vec3(cubicPlaces.xy, vPage), 0.0), textureLod(pages, vec3(cubicPlaces.zy, vPage), 0.0), cubicShares.x);
  vec4 lower = mix(textureLod(pages, vec3(cubicPlaces.xw, vPage), 0.0), textureLod(pages, vec3(cubicPlaces.zw, vPage), 0.0), cubicShares.x);
  vec4 fine = mix(upper, lower, cubicShares.y);
  return level > 0.0 ? mix(fine, textureLod(pages, vec3(vTexel / uPageSize, vPage), 1.0), level) : fine;
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
  placeCubic();
  if (uPicture == ${pictureNumber['sky-view']}) {
    outColor = falseColour(pageAt(uMeasure).r);
    return;
  }
  if (uPicture == ${pictureNumber.layer}) {
    int last = textureSize(uRamp, 0).x - 1;
    outColor = texelFetch(uRamp, ivec2(int(clamp(pageAt(uMeasure).r, 0.0, 1.0) * float(last) + 0.5), 0), 0);
    return;
  }
  vec3 illuminance = vIsHere == 1 ? lightOf(uLight, uIndirect, vScale, uSunKlx[0])
    : ${untilLoaded} * (uParts.x * vScale.y * uSunKlx[0] + uParts.y * vScale.x);
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
