import * as THREE from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import type { City } from './city';
import type { Batch } from './city_batches';

/** Where a ray meets the city. Scene coordinates (y up). */
export interface Hit {
  point: THREE.Vector3;
  distance: number;
  /** Of the triangle as it is wound; cities have inverted faces. */
  normal: THREE.Vector3;
  triangle: number;
}

/** The surface at a place: what leads to its light and its colour. */
export interface SurfacePoint {
  chart: number;
  /** Of the lightmap. */
  page: number;
  /** Column and row in that page; centres of texels at ½. */
  texel: THREE.Vector2;
  /** Linear. */
  tint: THREE.Vector3;
  map: THREE.Texture | null;
  uv: THREE.Vector2 | null;
  /** The place on the same plane that has another texel. */
  pointAt(texel: THREE.Vector2): THREE.Vector3;
}

/** Rays against all triangles of the city. */
export class CityRays {
  private constructor(
    private readonly bvh: MeshBVH,
    private readonly batches: readonly Batch[],
    private readonly firstVertex: readonly number[],
  ) {}

  /** A tree over all triangles; about half a second per million of them. */
  static build({ batches }: City): CityRays {
    let vertexCount = 0;
    let indexCount = 0;
    for (const { geometry } of batches) {
      vertexCount += geometry.getAttribute('position').count;
      indexCount += geometry.index?.count ?? 0;
    }
    const position = new Float32Array(vertexCount * 3);
    const index = new Uint32Array(indexCount);
    const firstVertex: number[] = [];
    let vertex = 0;
    let slot = 0;
    for (const { geometry } of batches) {
      const source = geometry.getAttribute('position');
      position.set(source.array, vertex * 3);
      const triangles = geometry.index?.array ?? [];
      for (let i = 0; i < triangles.length; ++i) index[slot + i] = vertex + (triangles[i] ?? 0);
      firstVertex.push(vertex);
      vertex += source.count;
      slot += triangles.length;
    }
    const merged = new THREE.BufferGeometry();
    merged.setAttribute('position', new THREE.BufferAttribute(position, 3));
    merged.setIndex(new THREE.BufferAttribute(index, 1));
    return new CityRays(new MeshBVH(merged), batches, firstVertex);
  }

  /** The first thing from a point in a unit direction, from either side. */
  first(origin: THREE.Vector3, direction: THREE.Vector3, limit = Infinity): Hit | null {
    const hit = this.bvh.raycastFirst(new THREE.Ray(origin, direction), THREE.DoubleSide, 0, limit);
    if (!hit) return null;
    return { point: hit.point, distance: hit.distance, normal: hit.face?.normal.clone() ?? new THREE.Vector3(0, 1, 0), triangle: hit.faceIndex ?? 0 };
  }

  /** What a hit says about light and colour. */
  surfaceAt({ point, triangle }: Hit): SurfacePoint | null {
    const index = this.bvh.geometry.index;
    if (!index) return null;
    const corners = [0, 1, 2].map((k) => index.getX(3 * triangle + k));
    const m = this.firstVertex.filter((first) => first <= (corners[0] ?? 0)).length - 1;
    const batch = this.batches[m];
    if (!batch) return null;
    const [a, b, c] = corners.map((corner) => corner - (this.firstVertex[m] ?? 0)) as [number, number, number];
    const { geometry, maps } = batch;
    const positionOf = (vertex: number): THREE.Vector3 => new THREE.Vector3().fromBufferAttribute(geometry.getAttribute('position'), vertex);
    const [pa, pb, pc] = [positionOf(a), positionOf(b), positionOf(c)];
    const weights = THREE.Triangle.getBarycoord(point, pa, pb, pc, new THREE.Vector3());
    if (!weights) return null;
    const coordinates = (name: string, vertex: number): THREE.Vector2 => {
      const attribute = geometry.getAttribute(name);
      return new THREE.Vector2(attribute.getX(vertex), attribute.getY(vertex));
    };
    const mixed = (name: string): THREE.Vector2 =>
      coordinates(name, a).multiplyScalar(weights.x).addScaledVector(coordinates(name, b), weights.y).addScaledVector(coordinates(name, c), weights.z);
    const [la, lb, lc] = [coordinates('texel', a), coordinates('texel', b), coordinates('texel', c)];
    return {
      chart: Math.round(geometry.getAttribute('chart').getX(a)),
      page: geometry.getAttribute('texel').getZ(a),
      texel: mixed('texel'),
      tint: new THREE.Vector3().fromBufferAttribute(geometry.getAttribute('tint'), a),
      map: maps[geometry.getAttribute('layer')?.getX(a) ?? -1] ?? null,
      uv: maps.length > 0 ? mixed('uv') : null,
      pointAt(texel) {
        // Texels are affine in the triangle's plane.
        const [e, f, g] = [lb.clone().sub(la), lc.clone().sub(la), texel.clone().sub(la)];
        const area = e.cross(f);
        if (area === 0) return point.clone();
        return pa.clone().addScaledVector(pb.clone().sub(pa), g.cross(f) / area).addScaledVector(pc.clone().sub(pa), e.cross(g) / area);
      },
    };
  }
}
