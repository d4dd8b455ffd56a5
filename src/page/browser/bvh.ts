// A tree of boxes over the triangles of patches, to find the first hit of a ray.

/** x, y, z. */
export type Point = [number, number, number];

export interface Hit {
  triangle: number;
  distance: number; // in lengths of the direction
}

interface Node {
  low: Point;
  high: Point;
  begin: number; // of `order`
  end: number;
  left: Node | null;
  right: Node | null;
}

const LEAF = 6;
const EDGE = 1e-7; // rays through a shared edge must hit one of its triangles

export class TriangleTree {
  private readonly order: Uint32Array;
  private readonly root: Node | null;

  constructor(private readonly position: Float32Array, private readonly triangle: Uint32Array) {
    const count = triangle.length / 3;
    const centre = new Float32Array(triangle.length);
    for (let t = 0; t < count; ++t) {
      for (let axis = 0; axis < 3; ++axis) {
        centre[t * 3 + axis] = (this.at(t, 0, axis) + this.at(t, 1, axis) + this.at(t, 2, axis)) / 3;
      }
    }
    this.order = Uint32Array.from({ length: count }, (_, t) => t);
    this.root = count > 0 ? this.build(0, count, centre) : null;
  }

  /** The nearest triangle with its front (counter-clockwise) hit by the ray, or null. */
  cast(from: Point, direction: Point): Hit | null {
    let best: Hit | null = null;
    const stack: Node[] = this.root ? [this.root] : [];
    for (let node = stack.pop(); node; node = stack.pop()) {
      if (entry(node, from, direction) > (best?.distance ?? Infinity)) continue;
      if (node.left && node.right) {
        const nearLeft = entry(node.left, from, direction) <= entry(node.right, from, direction);
        stack.push(nearLeft ? node.right : node.left, nearLeft ? node.left : node.right);
        continue;
      }
      for (let k = node.begin; k < node.end; ++k) {
        const triangle = this.order[k]!;
        const distance = this.meet(triangle, from, direction);
        if (distance < (best?.distance ?? Infinity)) best = { triangle, distance };
      }
    }
    return best;
  }

  /** The unit vector towards its front. */
  normal(t: number): Point {
    const a = this.corner(t, 0);
    const n = cross(minus(this.corner(t, 1), a), minus(this.corner(t, 2), a));
    const length = Math.sqrt(dot(n, n));
    return [n[0] / length, n[1] / length, n[2] / length];
  }

  private at(t: number, corner: number, axis: number): number {
    return this.position[this.triangle[t * 3 + corner]! * 3 + axis]!;
  }

  private build(begin: number, end: number, centre: Float32Array): Node {
    const low: Point = [Infinity, Infinity, Infinity];
    const high: Point = [-Infinity, -Infinity, -Infinity];
    for (let k = begin; k < end; ++k) {
      for (let corner = 0; corner < 3; ++corner) {
        for (let axis = 0; axis < 3; ++axis) {
          const x = this.at(this.order[k]!, corner, axis);
          low[axis] = Math.min(low[axis]!, x);
          high[axis] = Math.max(high[axis]!, x);
        }
      }
    }
    const node: Node = { low, high, begin, end, left: null, right: null };
    if (end - begin <= LEAF) return node;
    const size = high.map((x, axis) => x - low[axis]!);
    const axis = size.indexOf(Math.max(...size));
    this.order.subarray(begin, end).sort((a, b) => centre[a * 3 + axis]! - centre[b * 3 + axis]!);
    const middle = (begin + end) >> 1;
    node.left = this.build(begin, middle, centre);
    node.right = this.build(middle, end, centre);
    return node;
  }

  /** Moeller & Trumbore 1997, fronts only; Infinity: no hit. */
  private meet(t: number, from: Point, direction: Point): number {
    const a = this.corner(t, 0);
    const e1 = minus(this.corner(t, 1), a), e2 = minus(this.corner(t, 2), a);
    const p = cross(direction, e2);
    const determinant = dot(e1, p);
    if (!(determinant > 0)) return Infinity;
    const s = minus(from, a);
    const u = dot(s, p) / determinant;
    if (u < -EDGE || u > 1 + EDGE) return Infinity;
    const q = cross(s, e1);
    const v = dot(direction, q) / determinant;
    if (v < -EDGE || u + v > 1 + EDGE) return Infinity;
    const distance = dot(e2, q) / determinant;
    return distance > 0 ? distance : Infinity;
  }

  private corner(t: number, corner: number): Point {
    return [this.at(t, corner, 0), this.at(t, corner, 1), this.at(t, corner, 2)];
  }
}

/** The distance at which the ray enters the box; Infinity: it does not. */
function entry(node: Node, from: Point, direction: Point): number {
  let near = 0, far = Infinity;
  for (let axis = 0; axis < 3; ++axis) {
    const inverse = 1 / direction[axis]!;
    const a = (node.low[axis]! - from[axis]!) * inverse;
    const b = (node.high[axis]! - from[axis]!) * inverse;
    if (Number.isNaN(a) || Number.isNaN(b)) continue; // along a face of the box
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far * (1 + 1e-6) ? near : Infinity;
}

const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Point, b: Point): Point =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
