import * as THREE from 'three';

const fragmentShader = /* glsl */ `
uniform sampler2D uColour;
uniform sampler2D uAlpha;
uniform bool uHasAlpha;
uniform int uLevel;
layout(location = 0) out vec4 outColor;

vec4 texelAt(ivec2 place) {
  vec4 colour = texelFetch(uColour, place, 0);
  return uHasAlpha ? vec4(colour.rgb, texelFetch(uAlpha, place, 0).r) : colour;
}

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  ivec2 first = 2 * place;
  outColor = uLevel == 0 ? texelAt(place)
    : 0.25 * (texelAt(first) + texelAt(first + ivec2(1, 0)) + texelAt(first + ivec2(0, 1)) + texelAt(first + ivec2(1, 1)));
}
`;

/** Draws pictures into layers of textures. */
export class LayerPainter {
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.Camera();
  private readonly triangle = new THREE.BufferGeometry();
  private readonly colour: THREE.IUniform<THREE.Texture | null> = { value: null };
  private readonly alpha: THREE.IUniform<THREE.Texture | null> = { value: null };
  private readonly hasAlpha = { value: false };
  private readonly level = { value: 0 };
  private readonly material = new THREE.ShaderMaterial({
    name: 'layers',
    glslVersion: THREE.GLSL3,
    uniforms: { uColour: this.colour, uAlpha: this.alpha, uHasAlpha: this.hasAlpha, uLevel: this.level },
    vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
    blending: THREE.NoBlending,
  });

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    this.triangle.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const mesh = new THREE.Mesh(this.triangle, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  /** Level 0 is the picture itself, level 1 the means of 2 × 2 of its pixels. `alpha`: a second picture whose red becomes the alpha. */
  paint(target: THREE.WebGLArrayRenderTarget, layer: number, levels: 1 | 2, colour: ImageBitmap, alpha: ImageBitmap | null): void {
    this.colour.value = makeSource(colour, target.texture.colorSpace);
    this.alpha.value = alpha && makeSource(alpha, THREE.NoColorSpace);
    this.hasAlpha.value = alpha !== null;
    for (let level = 0; level < levels; ++level) {
      this.level.value = level;
      this.draw(target, layer, level, colour.width >> level, colour.height >> level);
    }
    for (const source of [this.colour, this.alpha]) {
      source.value?.dispose();
      source.value = null;
    }
  }

  private draw(target: THREE.WebGLArrayRenderTarget, layer: number, level: number, width: number, height: number): void {
    target.viewport.set(0, 0, width, height);
    this.renderer.setRenderTarget(target, layer, level);
    this.renderer.render(this.scene, this.camera);
    this.renderer.setRenderTarget(null);
  }

  /** Layers that a texture can have on this card. */
  get mostLayers(): number {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    return gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number;
  }

  dispose(): void {
    this.triangle.dispose();
    this.material.dispose();
  }
}

function makeSource(picture: ImageBitmap, colorSpace: string): THREE.Texture {
  const texture = new THREE.Texture(picture);
  texture.colorSpace = colorSpace;
  texture.flipY = false;
  texture.minFilter = texture.magFilter = THREE.NearestFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}

/** Lightmap pages as the layers of one texture: 8 bit, with the one coarser level that the gutters allow. Smaller pages leave a part of their layer empty. */
export class PageLayers {
  private readonly target: THREE.WebGLArrayRenderTarget;

  /** @param content light: sRGB-coded colours and a linear alpha; share: one linear number */
  constructor(private readonly painter: LayerPainter, pages: readonly { width: number; height: number }[], content: 'light' | 'share') {
    const width = Math.max(...pages.map((page) => page.width));
    const height = Math.max(...pages.map((page) => page.height));
    this.target = new THREE.WebGLArrayRenderTarget(width, height, pages.length, {
      format: content === 'light' ? THREE.RGBAFormat : THREE.RedFormat,
      colorSpace: content === 'light' ? THREE.SRGBColorSpace : THREE.NoColorSpace,
      minFilter: THREE.LinearMipmapLinearFilter,
      magFilter: THREE.LinearFilter,
      generateMipmaps: false,
      depthBuffer: false,
    });
    this.target.texture.mipmaps = [{}, {}] as THREE.DataArrayTexture['mipmaps']; // three allocates a level for each
  }

  get texture(): THREE.Texture {
    return this.target.texture;
  }

  /** On the graphics card. */
  get bytes(): number {
    const { width, height, depth, texture } = this.target;
    return (texture.format === THREE.RedFormat ? 1 : 4) * depth * (width * height + (width >> 1) * (height >> 1));
  }

  /** Puts a page, and closes its pictures. */
  put(page: number, colour: ImageBitmap, alpha: ImageBitmap | null): void {
    this.painter.paint(this.target, page, 2, colour, alpha);
    colour.close();
    alpha?.close();
  }

  dispose(): void {
    this.target.dispose();
  }
}

/** Pictures of one size as the layers of one texture, with all mip levels. */
export function makePictureLayers(painter: LayerPainter, pictures: readonly ImageBitmap[], wrap: [THREE.Wrapping, THREE.Wrapping], anisotropy: number): THREE.WebGLArrayRenderTarget {
  const [first] = pictures;
  const target = new THREE.WebGLArrayRenderTarget(first?.width ?? 1, first?.height ?? 1, pictures.length, {
    colorSpace: THREE.SRGBColorSpace,
    wrapS: wrap[0],
    wrapT: wrap[1],
    minFilter: THREE.LinearMipmapLinearFilter,
    magFilter: THREE.LinearFilter,
    generateMipmaps: true,
    depthBuffer: false,
    anisotropy,
  });
  target.texture.mipmapsAutoUpdate = false;
  pictures.forEach((picture, layer) => {
    target.texture.mipmapsAutoUpdate = layer === pictures.length - 1; // the coarser levels once, at the end
    painter.paint(target, layer, 1, picture, null);
  });
  return target;
}
