import * as THREE from 'three';
import { differenceColours } from '../core/false_colour';

const fragmentShader = /* glsl */ `
uniform sampler2D uBefore; // lx, metres from the eye (0: sky)
uniform sampler2D uAfter;
uniform float uRange;
layout(location = 0) out vec4 outColor;
const vec3 kColours[3] = vec3[](${differenceColours.map((code) => `vec3(${code.map((c) => (c / 255).toFixed(6)).join(', ')})`).join(', ')});

// Contours, so that a city without changes still shows its houses: 1 / distance is nearly linear on a plane, so its second difference marks edges.
float contour(ivec2 pixel, float metres) {
  vec2 bend = vec2(0.0);
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 aside = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
    float left = texelFetch(uAfter, max(pixel - aside, ivec2(0)), 0).g;
    float right = texelFetch(uAfter, min(pixel + aside, textureSize(uAfter, 0) - 1), 0).g;
    bend[axis] = left == 0.0 || right == 0.0 ? 0.0 : abs(metres / left + metres / right - 2.0);
  }
  return smoothstep(0.0008, 0.006, max(bend.x, bend.y));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 before = texelFetch(uBefore, pixel, 0).rg;
  vec2 after = texelFetch(uAfter, pixel, 0).rg;
  if (before.g == 0.0 && after.g == 0.0) {
    outColor = vec4(vec3(0.906), 1.0); // 0.8 linear: the paper of measures
    return;
  }
  // Depth of both is good to far better than this; what stands apart by more is another surface.
  bool isSame = before.g > 0.0 && after.g > 0.0 && abs(before.g - after.g) < 0.05 + 0.005 * before.g;
  if (!isSame) {
    bool isStripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 5.0;
    outColor = vec4(isStripe ? vec3(0.36, 0.36, 0.38) : vec3(0.52, 0.52, 0.54), 1.0);
    return;
  }
  float change = clamp((after.r - before.r) / uRange, -1.0, 1.0);
  vec3 colour = change < 0.0 ? mix(kColours[1], kColours[0], -change) : mix(kColours[1], kColours[2], change);
  outColor = vec4(mix(colour, vec3(0.25), 0.55 * contour(pixel, after.g)), 1.0);
}
`;

/** What a second bake has more or less of illuminance than a first, pixel by pixel, where both show the same surface. */
export class DifferencePass {
  private readonly before = makeTarget();
  private readonly after = makeTarget();
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.Camera();
  private readonly material: THREE.ShaderMaterial;
  private readonly triangle = new THREE.BufferGeometry();

  constructor() {
    this.triangle.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.material = new THREE.ShaderMaterial({
      name: 'difference',
      glslVersion: THREE.GLSL3,
      uniforms: { uBefore: { value: this.before.texture }, uAfter: { value: this.after.texture }, uRange: { value: 1 } },
      vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader,
      depthTest: false,
      depthWrite: false,
      toneMapped: false,
    });
    const mesh = new THREE.Mesh(this.triangle, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  /** @param drawNumbers draws lux and distance of one bake (0: before, 1: after) */
  draw(renderer: THREE.WebGLRenderer, rangeLx: number, drawNumbers: (which: 0 | 1) => void): void {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    for (const [which, target] of [[0, this.before], [1, this.after]] as const) {
      if (target.width !== size.x || target.height !== size.y) target.setSize(size.x, size.y);
      renderer.setRenderTarget(target);
      drawNumbers(which);
    }
    renderer.setRenderTarget(null);
    (this.material.uniforms['uRange'] as THREE.IUniform<number>).value = rangeLx;
    renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.before.dispose();
    this.after.dispose();
    this.triangle.dispose();
    this.material.dispose();
  }
}

function makeTarget(): THREE.WebGLRenderTarget {
  return new THREE.WebGLRenderTarget(1, 1, { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false });
}
