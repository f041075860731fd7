import * as THREE from 'three';
import type { BakedInstant } from '../core/bake';
import { airShader } from './air';
import { displayShader, firstMeasure, numbersPicture, type SharedUniforms } from './city_material';

const vertexShader = /* glsl */ `
uniform mat4 uClipToWorld;
out vec3 vRay;
void main() {
  // A triangle that covers the picture, at the far plane: only what the city leaves free is shaded.
  vec2 corner = position.xy;
  vec4 near = uClipToWorld * vec4(corner, -1.0, 1.0);
  vec4 far = uClipToWorld * vec4(corner, 1.0, 1.0);
  vRay = far.xyz / far.w - near.xyz / near.w;
  gl_Position = vec4(corner, 1.0, 1.0);
}
`;

const fragmentShader = /* glsl */ `
in vec3 vRay;
uniform sampler2D uPanorama;
uniform sampler2D uPanoramaB;
uniform vec3 uSunDirection[2];
uniform vec3 uSunKlx[2];
uniform vec3 uLand[2];
uniform float uLandHeight;
uniform float uSunRadius[2];
uniform float uPanoramaHeight;
uniform int uPicture;
layout(location = 0) out vec4 outColor;
${displayShader}
${airShader}

const float kPi = 3.141592653589793;

void main() {
  vec3 direction = normalize(vRay);
  if (uPicture == ${numbersPicture}) { // numbers: no surface
    outColor = vec4(0.0);
    return;
  }
  if (uPicture >= ${firstMeasure}) { // measures: paper behind them, of a grey that the scale does not hold
    outColor = linearToOutputTexel(vec4(vec3(0.8), 1.0));
    return;
  }
  if (uPicture == 1) { // textures alone: paper behind them, no light
    float shade = mix(0.62, 0.82, smoothstep(-0.3, 0.6, direction.y));
    vec4 paper = linearToOutputTexel(vec4(vec3(shade) * vec3(0.93, 0.96, 1.0), 1.0));
    outColor = vec4(paper.rgb + (ditherNoise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
    return;
  }
  // Scene: x east, y up, z south. Azimuth runs clockwise from grid north; row 0 of the panorama is the zenith.
  float elevation = asin(clamp(direction.y, -1.0, 1.0));
  float azimuth = atan(direction.x, -direction.z);
  // The first row's centre is the zenith, the last row's the horizon; no gradients, so that the seam at azimuth 0 stays sharp.
  float row = clamp(1.0 - elevation / (0.5 * kPi), 0.0, 1.0) * (uPanoramaHeight - 1.0) + 0.5;
  vec2 place = vec2(azimuth / (2.0 * kPi), row / uPanoramaHeight);
  vec3 sky = textureLod(uPanorama, place, 0.0).rgb;
  if (uBlend > 0.0) sky = mix(sky, textureLod(uPanoramaB, place, 0.0).rgb, uBlend);

  // Below the horizon level land goes on as far as the air lets one see; the horizon's edge is as wide as a pixel.
  float pixel = max(length(fwidth(direction)), 1e-5);
  float toLand = max(cameraPosition.y - uLandHeight, 1.0) / max(-direction.y, 1e-5);
  vec3 land = throughAir(mix(uLand[0], uLand[1], uBlend), direction, toLand);
  vec3 radiance = mix(land, sky, smoothstep(-0.5 * pixel, 0.5 * pixel, elevation));

  for (int i = 0; i < 2; ++i) { // between two instants both suns are there, each as far as its light is
    float share = i == 0 ? 1.0 - uBlend : uBlend;
    if (share == 0.0 || uSunRadius[i] == 0.0) continue;
    float angle = acos(clamp(dot(direction, uSunDirection[i]), -1.0, 1.0));
    // Half the beam within the disc would already be white; the disc keeps its true radius, softened over one pixel.
    float disc = (1.0 - smoothstep(uSunRadius[i] - 0.5 * pixel, uSunRadius[i] + 0.5 * pixel, angle)) * smoothstep(-0.5 * pixel, 0.5 * pixel, elevation);
    vec3 discRadiance = uSunKlx[i] / (kPi * uSunRadius[i] * uSunRadius[i]);
    // Forward scatter of the eye and of haze about the sun; strength and width by eye, well below the sky's own aureole from 5° on.
    vec3 glow = uSunKlx[i] * (0.6 * exp(-angle / 0.012) + 0.05 * exp(-angle / 0.06)) * smoothstep(-0.02, 0.01, elevation);
    radiance += share * (disc * discRadiance + glow);
  }
  // Half-float targets and the tone mapper's logarithm stay finite.
  outColor = toDisplay(min(radiance, vec3(6.0e4)));
}
`;

interface SkyUniforms {
  uPanorama: THREE.IUniform<THREE.Texture | null>;
  uPanoramaB: THREE.IUniform<THREE.Texture | null>;
  uPanoramaHeight: THREE.IUniform<number>;
  uSunDirection: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uSunRadius: THREE.IUniform<[number, number]>;
  uLand: THREE.IUniform<[THREE.Vector3, THREE.Vector3]>;
  uLandHeight: THREE.IUniform<number>;
}

/** The sky that the bake's light came from, with the sun's disc in its true size. */
export class SkyDome {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  private readonly clipToWorld = new THREE.Matrix4();

  constructor(shared: SharedUniforms) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const material = new THREE.ShaderMaterial({
      name: 'sky',
      glslVersion: THREE.GLSL3,
      uniforms: {
        ...shared,
        uClipToWorld: { value: this.clipToWorld },
        uPanorama: { value: null },
        uPanoramaB: { value: null },
        uPanoramaHeight: { value: 1 },
        uSunDirection: { value: [new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 1, 0)] },
        uSunRadius: { value: [0, 0] }, // 0: no sun
        uLand: { value: [new THREE.Vector3(), new THREE.Vector3()] },
        uLandHeight: { value: 0 },
      },
      vertexShader,
      fragmentShader,
      depthWrite: false,
      depthFunc: THREE.LessEqualDepth,
    });
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.renderOrder = 1; // after the city
    this.mesh.onBeforeRender = (_renderer, _scene, camera) => {
      this.clipToWorld.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
    };
  }

  /** The sky of the instant on show (slot 0), or of the one that it fades into. `landHeightM` is where the land about the city lies. */
  apply(slot: 0 | 1, panorama: THREE.DataTexture, instant: BakedInstant, landHeightM: number): void {
    const uniforms = this.mesh.material.uniforms as unknown as SkyUniforms;
    const { sun } = instant;
    const [east, north, up] = sun.direction;
    uniforms[slot === 0 ? 'uPanorama' : 'uPanoramaB'].value = panorama;
    uniforms.uPanoramaHeight.value = panorama.image.height;
    uniforms.uSunDirection.value[slot].set(east, up, -north).normalize();
    const hasSun = sun.shape !== 'none' && sun.normal_illuminance_klx.some((klx) => klx > 0);
    uniforms.uSunRadius.value[slot] = hasSun ? THREE.MathUtils.degToRad(sun.angular_radius_deg) : 0;
    uniforms.uLand.value[slot].fromArray(instant.sky.land_kcd_m2);
    uniforms.uLandHeight.value = landHeightM;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
