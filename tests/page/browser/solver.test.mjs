// The solvers and the decoding of form factors, against LAPACK and closed forms.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { folder, module, pageData, relativeError, results } from "./support.mjs";

const { expand, denseRow } = await module("factors");
const solver = await module("solver");
const { Relight } = await module("relight");
const { VectorProduct } = await module("vector_product");
const { Session } = await module("session");
const { directIrradiance, factorsOf, materialsOfNodes, nodeMeans, patchIrradiance, radiosityOf, withMaterials } = await module("light");
const { TriangleTree } = await module("bvh");
const { readContainer } = await module("container");

const kernel = readFileSync(join(folder, "modules/product.wasm"));
const data = await pageData("small.html");
const truth = results("small.h5", "--dense");
const quantised = data.header.quantisation.largest_relative_error;

function factorsIn({ header, nodeArea, factorBegin, factorColumn, factorCode }) {
  const { lowest, step } = header.quantisation;
  return { area: nodeArea, begin: factorBegin, column: factorColumn, code: factorCode, lowest, step };
}
const stored = factorsIn(data);
const factors = expand(stored);
const dark = new Float32Array(factors.size * 3);
const system = { factors, emission: data.emission, reflectance: data.reflectance, more: dark };

// 16 bits: the page states how far a form factor may be off; 1e-6 is for areas and values in 32 bits.
test("both triangles are the matrix of the results file, to the error the page states", () => {
  for (let i = 0; i < factors.size; ++i) {
    const row = denseRow(factors, i);
    truth.factors[i].forEach((f, j) => {
      assert.ok(
        Math.abs(row[j] - f) <= (quantised + 1e-6) * f + 1e-9 / factors.size,
        `F[${i},${j}] = ${row[j]}, not ${f}`,
      );
    });
    for (let k = factors.begin[i] + 1; k < factors.begin[i + 1]; ++k) {
      assert.ok(factors.column[k] > factors.column[k - 1], `columns of row ${i} must increase`);
    }
  }
});

test("rows of all columns decode like rows with columns", () => {
  const size = 3,
    code = Uint16Array.from([0, 10, 20, 0, 30, 5]);
  const area = Float32Array.from([1, 2, 4]);
  const dense = expand({
    area,
    begin: Uint32Array.from([0, 3, 5, 6]),
    column: new Uint32Array(0),
    code,
    lowest: -5,
    step: 0.1,
  });
  const sparse = expand({
    area,
    begin: Uint32Array.from([0, 2, 3, 4]),
    column: Uint32Array.from([1, 2, 2, 2]),
    code: Uint16Array.from([10, 20, 30, 5]),
    lowest: -5,
    step: 0.1,
  });
  for (let i = 0; i < size; ++i) assert.deepEqual(denseRow(dense, i), denseRow(sparse, i));
  assert.equal(denseRow(dense, 1)[0], Math.fround(Math.fround(Math.exp(-4)) / 2)); // F_10 = F_01 A_0 / A_1
  assert.equal(dense.diagonal[2], Math.fround(Math.exp(-4.5)));
});

// A sum of n products in 32 bits is off by n / 4 roundings at most, four sums taking turns, and by far less as a rule.
test("the product by vectors is the plain one, for rows of any length", () => {
  const vectors = new VectorProduct(stored, kernel);
  const lengths = Array.from({ length: factors.size }, (_, i) => factors.begin[i + 1] - factors.begin[i]);
  assert.equal(new Set(lengths.map((length) => length % 4)).size, 4);
  assert.deepEqual(vectors.factors.value, factors.value);
  const x = Float64Array.from({ length: 3 * factors.size }, (_, k) => 1 + Math.sin(k));
  const plain = solver.product(factors, x);
  vectors.multiply(x).forEach((value, k) => assert.ok(Math.abs(value - plain[k]) <= 2e-6 * plain[k], `${k}: ${value}`));
});

test("the product by vectors of rows without entries is 0", () => {
  const none = { area: Float32Array.of(1, 1), begin: Uint32Array.of(0, 0, 0), column: new Uint32Array(0) };
  const vectors = new VectorProduct({ ...none, code: new Uint16Array(0), lowest: 0, step: 0 }, kernel);
  assert.deepEqual(vectors.multiply(new Float64Array(6).fill(1)), new Float64Array(6));
});

/** Iterates until nothing changes in 64 bits but rounding. */
function solve(method, sys = system, sweeps = 60) {
  if (method === "relight") {
    // From no light at all; the source is only for its scale.
    const dark = { irradiance: new Float64Array(3 * sys.factors.size), source: solver.source(sys) };
    const relight = new Relight(sys, dark, (x) => solver.product(sys.factors, x));
    relight.run(1e-9, () => relight.products > 40);
    return radiosityOf({ ...sys, irradiance: relight.irradiance() });
  }
  if (method === "southwell") {
    const state = solver.southwellStart(sys);
    for (let n = 0; n < 40 * sys.factors.size && solver.southwellShot(sys, state); ++n);
    return state.iterate.radiosity;
  }
  let iterate = solver.fromEmission(sys);
  const scale = solver.scales(solver.source(sys));
  for (let n = 0; n < sweeps; ++n) {
    if (method === "jacobi") iterate = solver.jacobiSweep(sys, iterate);
    else solver.gaussSeidelSweep(sys, iterate, scale);
  }
  return iterate.radiosity;
}

// The solution by LAPACK is of the matrix before its 16 bits: those weigh 2e-4 a factor at most, with either sign, and
// every bounce weighs less. Half of it holds with room; a wrong triangle or band is off by per cents.
for (const method of ["jacobi", "gauss-seidel", "southwell", "relight"]) {
  test(`${method} finds what LAPACK finds`, () => {
    const error = relativeError(solve(method), truth.solved);
    assert.ok(error < 0.5 * quantised, `off by ${error}`);
  });
}

// A closed room of K patches that see each other alike, F_ij = 1/K with itself: B = E / (1 - rho), whatever F.
function furnace() {
  const size = 12;
  return {
    factors: {
      size,
      begin: Uint32Array.from({ length: size + 1 }, (_, i) => i * size),
      column: Uint16Array.from({ length: size * size }, (_, k) => k % size),
      value: new Float32Array(size * size).fill(1 / size),
      diagonal: new Float32Array(size).fill(1 / size),
      area: new Float32Array(size).fill(2),
    },
    emission: Float32Array.from({ length: size * 3 }, (_, k) => 1 + (k % 3)),
    reflectance: new Float32Array(size * 3).fill(0.5),
    more: new Float32Array(size * 3),
  };
}

test("the furnace: B = E / (1 - rho) by every solver", () => {
  for (const method of ["jacobi", "gauss-seidel", "southwell", "relight"]) {
    solve(method, furnace()).forEach((b, k) => {
      // 1/12 in 32 bits sums to 1 within 12 roundings, doubled by the bounces; Southwell stops with what is left
      // unsent.
      assert.ok(Math.abs(b - 2 * (1 + (k % 3))) < 1e-5, `${method}: B = ${b}`);
    });
  }
});

test("Jacobi's residuals are the history of the program", () => {
  let iterate = solver.fromEmission(system);
  truth.history.slice(0, 8).forEach((told, n) => {
    const gathered = solver.irradianceOf(system, iterate.radiosity);
    const residual = solver.residual(system, iterate.radiosity, gathered);
    assert.ok(Math.abs(residual - told) < 5 * quantised * told, `sweep ${n}: ${residual}, the program ${told}`);
    iterate = solver.jacobiSweep(system, iterate, gathered);
  });
});

// As the program's: the largest change of each sweep; once that is within the tolerance, the residual.
test("Gauss-Seidel's changes are the history of the program", async () => {
  const swept = await pageData("sweeps.html");
  const { history } = results("sweeps.h5");
  const factors = expand(factorsIn(swept));
  const { emission, reflectance } = swept;
  const system = { factors, emission, reflectance, more: new Float32Array(emission.length) };
  const iterate = solver.fromEmission(system);
  const scale = solver.scales(solver.source(system));
  assert.ok(history.length > 5);
  history.forEach((told, n) => {
    const change = solver.gaussSeidelSweep(system, iterate, scale, swept.order);
    const gathered = solver.irradianceOf(system, iterate.radiosity);
    const last = n === history.length - 1;
    const found = last ? solver.residual(system, iterate.radiosity, gathered) : change;
    assert.ok(Math.abs(found - told) < 5 * quantised * told, `sweep ${n + 1}: ${found}, the program ${told}`);
  });
});

test("Southwell's first shot is the lamp's light, and what waits is its residual", () => {
  const state = solver.southwellStart(system);
  const lamp = data.emission.indexOf(Math.max(...data.emission));
  assert.ok(solver.southwellShot(system, state));
  assert.ok(state.sent[lamp] > 0 && state.sent.filter((x) => x > 0).length === 3);
  const gathered = solver.irradianceOf(system, state.sent);
  const residual = solver.residual(system, state.sent, gathered);
  // Two ways to the same number: kept as shots are made, and a product of the whole matrix.
  assert.ok(Math.abs(solver.southwellResidual(system, state) - residual) < 1e-9);
});

const materialsWith = ({ emission, reflectance }) => ({ emission, reflectance, direct: dark });

function session(withKernel = true) {
  const load = { stored, order: null, materials: materialsWith(data), irradiance: data.irradiance, arePatches: true };
  return new Session(load, withKernel ? kernel : null);
}

// Before the first shot nothing was sent: the brightest lamp waits, and it is what residuals are relative to.
test("a watched run of Southwell starts with all of the lamps' light unsent", () => {
  const materials = materialsWith(data);
  const watched = session();
  assert.equal(watched.start(1, "southwell", materials).residual, 1);
  let last = 1;
  for (let n = 0; n < 60; ++n) last = watched.step(1).residual;
  assert.ok(last < 0.1, `${last}`);
});

test("the stored light is that of the stored form factors", () => {
  assert.ok(session().loaded.agreement < quantised);
});

test("a lamp of twice the power is solved for at once; new reflectances to 1e-3", () => {
  const states = data.header.materials.map(({ reflectance, emission }) => ({
    reflectance,
    emission: emission.map((x) => 2 * x),
  }));
  const doubled = withMaterials(data, states);
  const lamp = session().relight(materialsWith(doubled), 1000);
  assert.ok(lamp.products <= 2, `${lamp.products} products`); // the start is right but for the 16 bits
  assert.ok(
    relativeError(
      lamp.irradiance,
      truth.irradiance.map((x) => 2 * x),
    ) < quantised,
  );

  // Darker, and as bright as it gets: there sweeps, which the expected light is made of, take hundreds.
  for (const [turn, vectors] of [
    [(x) => 0.6 * x, true],
    [() => 0.95, true],
    [() => 0.95, false],
  ]) {
    const reflectance = data.reflectance.map(turn);
    const relit = session(vectors).relight(materialsWith({ emission: data.emission, reflectance }), 10000);
    const expected = solve("gauss-seidel", { ...system, reflectance }, 400);
    const radiosity = radiosityOf({ emission: data.emission, reflectance, irradiance: relit.irradiance });
    assert.ok(relit.converged);
    assert.ok(relit.products <= 15, `${relit.products} products`);
    for (let k = 0; k < expected.length; ++k) {
      assert.ok(
        Math.abs(radiosity[k] - expected[k]) <= 1e-3 * expected[k],
        `B[${k}] = ${radiosity[k]}, not ${expected[k]}`,
      );
    }
  }
});

// Patches summed to nodes: the light of the program stands at the stored materials, whatever the nodes' form factors.
test("where patches are summed to nodes the stored light comes back, and a lamp alone scales it", async () => {
  const nodes = await pageData("nodes.html");
  const before = nodes.header.materials.map(({ reflectance, emission }) => ({ reflectance, emission }));
  const direct = directIrradiance(nodes, factorsOf(nodes, before, []));
  const materials = materialsOfNodes(nodes, withMaterials(nodes, before), direct);
  assert.ok(materials.emission.every((e) => e === 0)); // each lamp is known patch by patch
  const session = new Session({
    stored: factorsIn(nodes), order: null, materials, irradiance: nodeMeans(nodes, nodes.irradiance), arePatches: false,
  }, kernel);
  const means = nodeMeans(nodes, direct);
  const reference = { direct, reflected: session.loaded.reference.map((h, k) => Math.max(0, h - means[k])) };
  const again = patchIrradiance(nodes, session.loaded.reference, direct, reference);
  assert.ok(relativeError(again, nodes.irradiance) < 1e-4);

  const bright = before.map(({ reflectance, emission }) => ({ reflectance, emission: emission.map((e) => 3 * e) }));
  const tripled = directIrradiance(nodes, factorsOf(nodes, bright, []));
  const relit = session.relight(materialsOfNodes(nodes, withMaterials(nodes, bright), tripled), 10000);
  const three = patchIrradiance(nodes, relit.irradiance, tripled, reference);
  // Relighting ends at 5e-5 of the mean irradiance.
  assert.ok(relativeError(three, nodes.irradiance.map((h) => 3 * h)) < 2e-4);
});

test("a relight that is cut short goes on to the same light", () => {
  const materials = materialsWith({ emission: data.emission, reflectance: data.reflectance.map((x) => 0.6 * x) });
  const whole = session().relight(materials, 10000);
  const cut = session();
  let part = cut.relight(materials, 0),
    products = part.products;
  while (!part.converged) {
    part = cut.relight(null, 0);
    products += part.products;
  }
  assert.equal(products, whole.products);
  assert.deepEqual(part.irradiance, whole.irradiance);
});

test("warming the solver up changes nothing", () => {
  const materials = materialsWith({ emission: data.emission, reflectance: data.reflectance.map((x) => 0.6 * x) });
  const warmed = session();
  warmed.warm();
  assert.deepEqual(warmed.relight(materials, 10000).irradiance, session().relight(materials, 10000).irradiance);
});

test("a room that keeps all its light has no solution, and is said to have none", () => {
  const lossless = { ...furnace(), reflectance: new Float32Array(12 * 3).fill(1) };
  const nothing = { irradiance: new Float64Array(36), source: solver.source(lossless) };
  const relight = new Relight(lossless, nothing, (x) => solver.product(lossless.factors, x));
  relight.run(1e-6, () => relight.products > 100);
  assert.ok(!(relight.residual <= 1e-6));
});

test("a ray finds the triangle that a search of all of them finds", () => {
  const tree = new TriangleTree(data.position, data.patchTriangle);
  const alone = Array.from(
    { length: data.trianglePatch.length },
    (_, t) => new TriangleTree(data.position, data.patchTriangle.subarray(3 * t, 3 * t + 3)),
  );
  const middle = [0, 1, 2].map((axis) => {
    const along = data.position.filter((_, k) => k % 3 === axis);
    return (Math.min(...along) + Math.max(...along)) / 2;
  });
  let hits = 0;
  for (let n = 0; n < 60; ++n) {
    const direction = [Math.sin(n), Math.cos(1.7 * n), Math.sin(2.3 * n + 1)]; // all about
    const from = middle.map((x, axis) => x + 0.2 * Math.sin(5 * n + axis));
    const nearest = Math.min(...alone.map((one) => one.cast(from, direction)?.distance ?? Infinity));
    const hit = tree.cast(from, direction);
    assert.equal(hit?.distance ?? Infinity, nearest);
    if (hit) ++hits;
  }
  assert.ok(hits > 20);
});

test("damaged data are refused with a line that says what", () => {
  assert.throws(() => readContainer(new ArrayBuffer(40)), /do not begin with RADPAGE1.*radiosity view/);
  const header = JSON.stringify({
    patches: 1,
    nodes: 1,
    arrays: { position: { type: "u8", offset: 0, length: 4 } },
  });
  const bytes = new TextEncoder().encode(`RADPAGE1\0\0\0\0\0\0\0\0${header}`);
  new DataView(bytes.buffer).setUint32(8, header.length, true);
  assert.throws(() => readContainer(bytes.buffer), /'position' is of type u8, f32 is needed/);
});
