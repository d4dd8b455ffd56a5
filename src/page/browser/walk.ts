// Steps of a walker, who goes through nothing that is seen: straight on, else along what is in the way.
import { Vector3 } from "three";
import type { TriangleTree } from "./bvh";

const CLEARANCE = 0.02; // of the scene's diagonal, to what is in the way
const WALLS = 2; // that a step may go along: in a corner it ends

/** The part of `step` from `from` that nothing is in the way of. */
export function freeStep(tree: TriangleTree, diagonal: number, from: Vector3, step: Vector3): Vector3 {
  const gone = new Vector3();
  let left = step.clone();
  for (let wall = 0; wall <= WALLS && left.length() > 0; ++wall) {
    const length = left.length();
    const direction = left.clone().divideScalar(length);
    const hit = tree.cast(from.clone().add(gone).toArray(), direction.toArray());
    if (!hit) return gone.add(left);
    const normal = new Vector3(...tree.normal(hit.triangle));
    const away = hit.distance - (CLEARANCE * diagonal) / -normal.dot(direction);
    if (away >= length) return gone.add(left);
    gone.addScaledVector(direction, Math.max(0, away));
    left = direction.multiplyScalar(length - Math.max(0, away));
    left.addScaledVector(normal, -left.dot(normal));
  }
  return gone;
}
