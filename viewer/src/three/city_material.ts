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

/** Charts in a row of the texture of scales. */
export const scalesWidth = 2048;

/** Uniforms that all materials share by reference: a change is seen by all of them at the next frame. */
export interface SharedUniforms extends AirUniforms {
  uScales: THREE.IUniform<THREE.Texture | null>;
  uScalesB: THREE.IUniform<THREE.Texture | null>;
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

/** The lightmap textures of one page, shared by the materials that lie in it; B: of the instant that the one on show fades into. */
export interface PageUniforms {
  uSkyPage: THREE.IUniform<THREE.Texture | null>;
  uSunPage: THREE.IUniform<THREE.Texture | null>;
  uIndirectPage: THREE.IUniform<THREE.Texture | null>;
  uSkyPageB: THREE.IUniform<THREE.Texture | null>;
  uSunPageB: THREE.IUniform<THREE.Texture | null>;
  uIndirectPageB: THREE.IUniform<THREE.Texture | null>;
  /** Of the sky view, or of the study's layer on show. */
  uMeasurePage: THREE.IUniform<THREE.Texture | null>;
  uLampPage: THREE.IUniform<THREE.Texture | null>;
  uPageSize: THREE.IUniform<THREE.Vector2>;
}

export function makeSharedUniforms(): SharedUniforms {
  return {
    uScales: { value: null },
    uScalesB: { value: null },
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
in vec2 uv1;
in float _chart;
uniform highp sampler2D uScales;
uniform highp sampler2D uScalesB;
uniform float uBlend;
uniform mat3 uMapTransform;
out vec2 vUv;
centroid out vec2 vLightUv;
flat out vec4 vScale;
flat out vec4 vScaleB;
out vec3 vPosition;
#ifdef USE_COLOR
out vec3 vTint;
#endif

void main() {
  #ifdef USE_MAP
    vUv = (uMapTransform * vec3(uv, 1.0)).xy;
  #else
    vUv = vec2(0.0);
  #endif
  #ifdef USE_COLOR
    vTint = color.rgb;
  #endif
  vLightUv = uv1;
  int chart = int(_chart + 0.5);
  ivec2 entry = ivec2(chart % ${scalesWidth}, chart / ${scalesWidth});
  vScale = texelFetch(uScales, entry, 0);
  vScaleB = uBlend > 0.0 ? texelFetch(uScalesB, entry, 0) : vec4(0.0);
  vPosition = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

// E [klx] = sky page (sRGB decoded by the hardware, before it filters) × the chart's sky scale
//         + sun page × the chart's sun scale × the beam's normal illuminance
//         + indirect page (likewise) × the chart's indirect scale + lamps' page × the chart's lamp scale;  L [kcd/m²] = albedo/π × E.
// The gutter about a chart is two texels wide: level 1 of the mip chain is the last one whose bilinear footprint stays inside it.
const fragmentShader = /* glsl */ `
in vec2 vUv;
centroid in vec2 vLightUv;
flat in vec4 vScale;
flat in vec4 vScaleB;
in vec3 vPosition;
#ifdef USE_COLOR
in vec3 vTint;
#endif
uniform sampler2D uSkyPage;
uniform sampler2D uSunPage;
uniform sampler2D uIndirectPage;
uniform sampler2D uSkyPageB;
uniform sampler2D uSunPageB;
uniform sampler2D uIndirectPageB;
uniform sampler2D uMeasurePage;
uniform sampler2D uRamp;
uniform sampler2D uLampPage;
uniform vec4 uParts;
uniform vec2 uPageSize;
uniform vec3 uSunKlx[2];
uniform vec3 uScale;
uniform vec3 uBaseColor;
uniform int uPicture;
#ifdef USE_MAP
uniform sampler2D uMap;
#endif
#ifdef USE_ALPHA_CUTOFF
uniform float uAlphaCutoff;
uniform float uBaseAlpha;
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

// Sun, sky and reflected light of one instant, klx.
vec3 lightOf(sampler2D skyPage, sampler2D sunPage, sampler2D indirectPage, vec4 scale, vec3 beam, float level) {
  vec3 sky = textureLod(skyPage, vLightUv, level).rgb * scale.x;
  float sunCosine = textureLod(sunPage, vLightUv, level).r * scale.y;
  vec3 indirect = scale.z > 0.0 ? textureLod(indirectPage, vLightUv, level).rgb * scale.z : vec3(0.0);
  return uParts.x * sunCosine * beam + uParts.y * sky + uParts.z * indirect;
}

void main() {
  vec3 albedo = uBaseColor;
  #ifdef USE_MAP
    vec4 texel = texture(uMap, vUv);
    albedo *= texel.rgb;
    #ifdef USE_ALPHA_CUTOFF
      if (texel.a * uBaseAlpha < uAlphaCutoff) discard;
    #endif
  #endif
  #ifdef USE_COLOR
    albedo *= vTint;
  #endif
  if (uPicture == ${pictureNumber.textures}) {
    outColor = linearToOutputTexel(vec4(albedo, 1.0));
    return;
  }
  if (uPicture == ${pictureNumber.light}) albedo = vec3(1.0);
  vec2 dx = dFdx(vLightUv) * uPageSize;
  vec2 dy = dFdy(vLightUv) * uPageSize;
  float level = clamp(0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-8)), 0.0, 1.0);
  if (uPicture == ${pictureNumber['sky-view']}) {
    outColor = falseColour(textureLod(uMeasurePage, vLightUv, level).r);
    return;
  }
  if (uPicture == ${pictureNumber.layer}) {
    float grey = textureLod(uMeasurePage, vLightUv, level).r;
    int last = textureSize(uRamp, 0).x - 1;
    outColor = texelFetch(uRamp, ivec2(int(grey * float(last) + 0.5), 0), 0);
    return;
  }
  vec3 illuminance = lightOf(uSkyPage, uSunPage, uIndirectPage, vScale, uSunKlx[0], level);
  if (uBlend > 0.0) illuminance = mix(illuminance, lightOf(uSkyPageB, uSunPageB, uIndirectPageB, vScaleB, uSunKlx[1], level), uBlend);
  if (vScale.w > 0.0) illuminance += uParts.w * textureLod(uLampPage, vLightUv, level).rgb * vScale.w;
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

/** What a glTF material tells about itself, as far as a baked Lambertian surface needs it. */
export interface SurfaceLook {
  name: string;
  map: THREE.Texture | null;
  baseColor: THREE.Color;
  baseAlpha: number;
  alphaCutoff: number | null;
  isDoubleSided: boolean;
  hasVertexColors: boolean;
}

export function makeCityMaterial(look: SurfaceLook, page: PageUniforms, shared: SharedUniforms): THREE.ShaderMaterial {
  const defines: Record<string, string> = {};
  // RECIPROCAL_PI and toneMapping need <common>-style definitions that three prepends only in part.
  defines['RECIPROCAL_PI'] = '0.3183098861837907';
  if (look.map) defines['USE_MAP'] = '';
  if (look.map && look.alphaCutoff !== null) defines['USE_ALPHA_CUTOFF'] = '';
  look.map?.updateMatrix();
  return new THREE.ShaderMaterial({
    name: look.name,
    glslVersion: THREE.GLSL3,
    defines,
    uniforms: {
      ...shared,
      ...page,
      uBaseColor: { value: look.baseColor },
      uBaseAlpha: { value: look.baseAlpha },
      uAlphaCutoff: { value: look.alphaCutoff ?? 0 },
      uMap: { value: look.map },
      uMapTransform: { value: look.map?.matrix ?? new THREE.Matrix3() },
    },
    vertexShader,
    fragmentShader,
    side: look.isDoubleSided ? THREE.DoubleSide : THREE.FrontSide,
    vertexColors: look.hasVertexColors,
  });
}
