import * as THREE from 'three';
import type { City } from './city';

/** Numbers of the lightmap pages, those first that fill most of the view about `eye`: by the sum of area / distance² of their triangles. */
export function pagesByNearness({ batches }: City, pageCount: number, eye: THREE.Vector3): number[] {
  const nearest = 5; // metres: what is nearer counts no more
  const weights = new Float64Array(pageCount);
  const triangle = new THREE.Triangle();
  const middle = new THREE.Vector3();
  for (const { geometry } of batches) {
    const [position, texel] = [geometry.getAttribute('position') as THREE.BufferAttribute, geometry.getAttribute('texel')];
    const corners = geometry.index?.array ?? [];
    for (let i = 0; i < corners.length; i += 3) {
      triangle.setFromAttributeAndIndices(position, corners[i] ?? 0, corners[i + 1] ?? 0, corners[i + 2] ?? 0);
      const distance = Math.max(nearest, triangle.getMidpoint(middle).distanceTo(eye));
      const page = texel.getZ(corners[i] ?? 0);
      weights[page] = (weights[page] ?? 0) + triangle.getArea() / distance ** 2;
    }
  }
  return Array.from(weights.keys()).sort((a, b) => (weights[b] ?? 0) - (weights[a] ?? 0));
}
