// What an eye sees: its hemicube, unfolded, the top in the middle and the four sides around it.
import { toSrgb } from "./colour";

/** Where a place of the unfolded hemicube is: -2 to 2 both ways, the top between -1 and 1. Null: a corner. */
export function stripPixel(x: number, y: number, resolution: number): number | null {
  const pixel = (u: number, v: number, rows: number) =>
    Math.min(rows - 1, Math.floor(v * rows)) * resolution + Math.min(resolution - 1, Math.floor(((u + 1) / 2) * resolution));
  const across = Math.abs(x) <= 1, up = Math.abs(y) <= 1;
  if (across && up) return pixel(x, (y + 1) / 2, resolution);
  if (!across && !up) return null;
  const [side, u, v] = x > 1 ? [0, y, 2 - x] : y > 1 ? [1, -x, 2 - y] : x < -1 ? [2, -y, 2 + x] : [3, x, 2 + y];
  const half = resolution / 2;
  return (resolution + side * half) * resolution + pixel(u, v, half);
}

/** Draws a strip of GatherGpu, as a viewer at the eye sees it: not mirrored. `exposure`: EV. */
export function drawHemicube(canvas: HTMLCanvasElement, strip: Float32Array, resolution: number, exposure: number): void {
  const size = 2 * resolution;
  canvas.width = canvas.height = size;
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(size, size);
  const scale = 2 ** exposure / Math.PI;
  for (let row = 0; row < size; ++row) {
    for (let column = 0; column < size; ++column) {
      const from = stripPixel(2 - (4 * (column + 0.5)) / size, 2 - (4 * (row + 0.5)) / size, resolution);
      if (from === null) continue;
      const to = 4 * (row * size + column);
      for (let b = 0; b < 3; ++b) {
        image.data[to + b] = 255 * toSrgb(Math.min(1, Math.max(0, strip[4 * from + b]! * scale)));
      }
      image.data[to + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
}
