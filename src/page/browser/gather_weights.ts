// Exact delta form factors of a hemicube's pixels: each is the integral over its pixel, in closed
// form (derived in src/formfactor/hemicube/delta_form_factors.h).

/** Rows of a hemicube's strip: the top face, then the upper halves of four sides. */
export const stripRows = (resolution: number): number => 3 * resolution;

/** Form factor of [0,a] x [0,b] on the top face, at height 1 (configuration factor B-3 of Howell's catalogue). */
function topIntegral(a: number, b: number): number {
  const p = Math.sqrt(1 + a * a), q = Math.sqrt(1 + b * b);
  return ((a / p) * Math.atan(b / p) + (b / q) * Math.atan(a / q)) / (2 * Math.PI);
}

/** An antiderivative over the rectangle (y, z) of a side face at distance 1. */
function sideIntegral(y: number, z: number): number {
  const p = Math.sqrt(1 + z * z);
  return -Math.atan(y / p) / p / (2 * Math.PI);
}

function over(integral: (a: number, b: number) => number, a: number, b: number, size: number): number {
  return integral(a + size, b + size) - integral(a, b + size) - integral(a + size, b) + integral(a, b);
}

/** resolution * stripRows values, row by row; they sum to 1. Rows of sides run from the horizon up. */
export function deltaFormFactors(resolution: number): Float32Array {
  const size = 2 / resolution;
  const weights = new Float32Array(resolution * stripRows(resolution));
  for (let x = 0; x < resolution; ++x) {
    const a = -1 + x * size;
    for (let y = 0; y < resolution; ++y) {
      weights[y * resolution + x] = over(topIntegral, a, -1 + y * size, size);
    }
    for (let y = 0; y < resolution / 2; ++y) {
      const weight = over(sideIntegral, a, y * size, size);
      for (let side = 0; side < 4; ++side) {
        weights[(resolution + (side * resolution) / 2 + y) * resolution + x] = weight;
      }
    }
  }
  return weights;
}
