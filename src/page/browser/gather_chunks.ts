// Runs of triangles that a face of a hemicube may see. A GPU clips triangles outside by itself; in
// software this costs about as much as drawing them.
import type { PageData } from "./container";

type Vec = readonly number[];

/** A face looks along `along` through the square |across|, |up| <= along. */
export interface Face {
  across: Vec;
  up: Vec;
  along: Vec;
  half: boolean; // only the part with 0 <= up
}

/** Normals of the planes that bound its view, all through the eye; the inside is in front of them. */
function planes({ across, up, along, half }: Face): Vec[] {
  const towards = (axis: Vec, sign: number): Vec => along.map((x, d) => x + sign * axis[d]!);
  return [towards(across, 1), towards(across, -1), towards(up, -1), half ? up : towards(up, 1)];
}

export class Chunks {
  private readonly begin: number[] = []; // corners of triangles
  private readonly middle: Float64Array; // of the box of each chunk
  private readonly reach: Float64Array; // half the edges of that box

  /** Triangles in the order of the page's data, where neighbours are near each other. `most`: in a chunk. */
  constructor(private readonly data: PageData, most: number) {
    const corners = data.patchTriangle.length;
    for (let first = 0; first < corners; first += 3 * most) this.begin.push(first);
    this.middle = new Float64Array(3 * this.begin.length);
    this.reach = new Float64Array(3 * this.begin.length);
    this.begin.push(corners);
    for (let c = 0; c + 1 < this.begin.length; ++c) this.findBox(c);
  }

  /** Calls `draw(first, count)` for runs of corners that include everything the face sees from `eye`. */
  seen(eye: Vec, face: Face, draw: (first: number, count: number) => void): void {
    const bounds = planes(face);
    let first = 0, end = 0;
    for (let c = 0; c + 1 < this.begin.length; ++c) {
      if (bounds.some((normal) => this.isBehind(c, eye, normal))) continue;
      if (this.begin[c]! > end) {
        if (end > first) draw(first, end - first);
        first = this.begin[c]!;
      }
      end = this.begin[c + 1]!;
    }
    if (end > first) draw(first, end - first);
  }

  /** Whether the whole box is behind a plane. */
  private isBehind(chunk: number, eye: Vec, normal: Vec): boolean {
    let most = 0;
    for (let d = 0; d < 3; ++d) {
      const k = 3 * chunk + d;
      most += normal[d]! * (this.middle[k]! - eye[d]!) + Math.abs(normal[d]!) * this.reach[k]!;
    }
    return most < 0;
  }

  private findBox(chunk: number): void {
    const { position, patchTriangle } = this.data;
    for (let d = 0; d < 3; ++d) {
      let low = Infinity, high = -Infinity;
      for (let corner = this.begin[chunk]!; corner < this.begin[chunk + 1]!; ++corner) {
        const x = position[3 * patchTriangle[corner]! + d]!;
        low = Math.min(low, x);
        high = Math.max(high, x);
      }
      this.middle[3 * chunk + d] = (low + high) / 2;
      this.reach[3 * chunk + d] = (high - low) / 2;
    }
  }
}
