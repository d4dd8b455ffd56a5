// Reads the container that `radiosity view` embeds: a JSON header and typed arrays (the format is
// in ../README.md). It checks the length of every array, so that a damaged page gives an error
// instead of a wrong picture.

export type Rgb = [number, number, number];

export interface SurfaceInfo {
  name: string;
  material: number;
}

export interface MaterialInfo {
  name: string;
  reflectance: Rgb;
  emission: Rgb; // exitance, W/m^2
  textured: boolean;
  factor: Rgb; // reflectance that its texture multiplies; without one it is `reflectance`
  emission_factor: Rgb; // likewise
  texture?: number | null; // of reflectance, of the header's textures
  emission_texture?: number | null;
}

export interface TextureInfo {
  name: string;
  width: number;
  height: number;
  repeat: boolean;
  scale: number; // multiplies its texels
}

/** Of a surface: K, W/m^2, W; null: undetermined. */
export interface SurfaceHeat {
  name: string;
  area: number; // m^2
  temperature: number | null; // mean
  lowest: number | null;
  highest: number | null;
  net_flux: number; // that it gives off
  radiated: number;
  convected: number;
}

/** Heat exchange on patches. */
export interface Heat {
  temperature: Float32Array; // N, K; NaN: undetermined
  netFlux: Float32Array; // N, W/m^2
  irradiance: Float32Array; // N, W/m^2
  radiosity: Float32Array; // N, W/m^2
}

/** A light without a surface, by its strength in `unit`. */
export interface LightInfo {
  name: string;
  kind: string;
  single: boolean; // the kind is an option of the command line
  unit: string;
  strength: Rgb;
  parameters: string; // ",NAME=VALUE" of each, as the command line has them
  radiance: Rgb; // from where nothing stands, W/m^2/sr
}

export interface Header {
  title: string;
  program: string;
  arguments: string; // by which the program draws this light; empty: not known
  bands: number;
  patches: number;
  nodes: number; // the patches, or clusters of these
  method: string;
  tolerance: number | null; // hemicubes have none
  closed: boolean;
  exposure: number; // pictures show radiance * 2^exposure
  lights: LightInfo[];
  camera: { eye: Rgb; target: Rgb; up: Rgb; fov: number };
  origin: Rgb; // added to every position
  diagonal: number; // metres
  surfaces: SurfaceInfo[];
  materials: MaterialInfo[];
  solver: { name: string; status: string; iterations: number; residual: number; tolerance: number; history: number[] };
  quantisation: {
    lowest: number;
    step: number;
    largest_relative_error: number;
    largest_row_error: number;
  };
  heat?: { message: string; surfaces: SurfaceHeat[] };
  textures?: TextureInfo[];
  element_lamps: { material?: number; light?: number }[]; // whose direct light elements have by itself
  arrays: Record<string, { type: string; offset: number; length: number }>;
}

/** All of a page's data; N patches, K nodes, T triangles, S shading vertices. */
export interface PageData {
  header: Header;
  position: Float32Array; // P*3
  patchTriangle: Uint32Array; // T*3, into position
  trianglePatch: Uint32Array; // T
  triangleCorner: Uint32Array; // T*3, shading vertices
  shadingBegin: Uint32Array; // S+1
  shadingPatch: Uint32Array;
  shadingWeight: Float32Array;
  edge: Uint32Array; // pairs of positions
  eyePosition: Float32Array; // G*3: eyes of gathering, the first G shading vertices; empty: none
  eyeNormal: Float32Array; // G*3; 0: does not look
  eyeAxis: Float32Array; // G*3, along its hemicube's first side
  normal: Float32Array; // N*3
  centroid: Float32Array; // N*3
  area: Float32Array; // N, m^2
  surface: Uint32Array; // N
  side: Uint8Array; // N; 0 front, 1 back
  node: Uint32Array; // N
  emission: Float32Array; // N*3, W/m^2
  reflectance: Float32Array; // N*3
  irradiance: Float32Array; // N*3, W/m^2
  nodeArea: Float32Array; // K
  rowSum: Float32Array; // K
  lightIrradiance: Float32Array[]; // N*3 by each light, W/m^2
  /** N*3 by what emits of each material, W/m^2; null: it is in the form factors alone. */
  emittedIrradiance: (Float32Array | null)[];
  rowError: Float32Array; // K; empty: the method has none
  factorBegin: Uint32Array; // K+1
  factorColumn: Uint32Array; // empty: rows hold every column from the diagonal on
  factorCode: Uint16Array;
  order: Uint32Array | null; // K: the order of nodes in the program's Gauss-Seidel
  heat: Heat | null;
  elementPosition: Float32Array;
  elementTriangle: Uint32Array;
  elementIrradiance: Float32Array; // Q*3, W/m^2
  elementPatch: Uint32Array; // Q: a patch with its material
  /** Q*3 of each of `element_lamps`: its direct share of the irradiance, of 65535. */
  elementShare: Uint16Array[];
  elementPlace: Float32Array; // Q*2, texture coordinates; empty: no material varies
  elementColour: Uint16Array; // Q*3, of 65535, multiplies the reflectance; empty: none has colours of vertices
  texture: Uint8Array[]; // rows of red, green, blue: sRGB, each less the one to its left
}

const MAGIC = "RADPAGE1";
const ALIGNMENT = 8;

class ContainerError extends Error {
  constructor(message: string) {
    super(`${message}; write the page again with radiosity view`);
  }
}

type Views = { f32: Float32Array; u32: Uint32Array; u16: Uint16Array; u8: Uint8Array };
const bytesOf = { f32: 4, u32: 4, u16: 2, u8: 1 };

function view<T extends keyof Views>(buffer: ArrayBuffer, header: Header, name: string, type: T): Views[T] {
  const entry = header.arrays[name];
  if (!entry) throw new ContainerError(`The page's data lack the array '${name}'`);
  if (entry.type !== type) {
    throw new ContainerError(`The array '${name}' is of type ${entry.type}, ${type} is needed`);
  }
  const end = entry.offset + entry.length * bytesOf[type];
  if (entry.offset % ALIGNMENT !== 0 || end > buffer.byteLength) {
    throw new ContainerError(`The array '${name}' lies beyond the end of the page's data`);
  }
  const types = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };
  return new types[type](buffer, entry.offset, entry.length) as Views[T];
}

function readHeader(buffer: ArrayBuffer): Header {
  const start = new Uint8Array(buffer, 0, Math.min(16, buffer.byteLength));
  if (start.length < 16 || new TextDecoder().decode(start.subarray(0, 8)) !== MAGIC) {
    throw new ContainerError("The page's data do not begin with RADPAGE1");
  }
  const length = new DataView(buffer).getUint32(8, true);
  if (16 + length > buffer.byteLength) throw new ContainerError("The page's data end within their header");
  return JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 16, length))) as Header;
}

function requireLength(name: string, array: ArrayLike<number>, length: number): void {
  if (array.length !== length) {
    throw new ContainerError(`The array '${name}' has ${array.length} values, ${length} are needed`);
  }
}

function requireBelow(name: string, indices: ArrayLike<number>, limit: number): void {
  for (let k = 0; k < indices.length; ++k) {
    if (indices[k]! >= limit) {
      throw new ContainerError(`The array '${name}' points at ${indices[k]}, of ${limit}`);
    }
  }
}

function check(data: PageData): void {
  const { patches: n, nodes: k } = data.header;
  const triangles = data.trianglePatch.length;
  const vertices = data.shadingBegin.length - 1;
  requireLength("patch_triangle", data.patchTriangle, triangles * 3);
  requireLength("triangle_corner", data.triangleCorner, triangles * 3);
  for (const name of ["normal", "centroid", "emission", "reflectance", "irradiance"] as const) {
    requireLength(name, data[name], n * 3);
  }
  for (const name of ["area", "surface", "side", "node"] as const) requireLength(name, data[name], n);
  for (const name of ["nodeArea", "rowSum"] as const) requireLength(name, data[name], k);
  for (const light of data.lightIrradiance) requireLength("light", light, n * 3);
  for (const light of data.emittedIrradiance) if (light) requireLength("emitted", light, n * 3);
  for (const values of Object.values(data.heat ?? {})) requireLength("heat", values as Float32Array, n);
  if (data.rowError.length > 0) requireLength("row_error", data.rowError, k);
  requireLength("factor_begin", data.factorBegin, k + 1);
  requireLength("factor_code", data.factorCode, data.factorBegin[k]!);
  if (data.factorColumn.length > 0) requireLength("factor_column", data.factorColumn, data.factorBegin[k]!);
  if (data.order) requireLength("order", data.order, k);
  requireLength("shading_patch", data.shadingPatch, data.shadingBegin[vertices]!);
  requireLength("shading_weight", data.shadingWeight, data.shadingPatch.length);
  if (data.eyePosition.length > 3 * vertices) requireLength("eye_position", data.eyePosition, 3 * vertices);
  for (const name of ["eyeNormal", "eyeAxis"] as const) requireLength(name, data[name], data.eyePosition.length);
  requireLength("element_irradiance", data.elementIrradiance, data.elementPosition.length);
  requireLength("element_patch", data.elementPatch, data.elementPosition.length / 3);
  for (const share of data.elementShare) requireLength("element_share", share, data.elementPosition.length);
  if (data.elementPlace.length > 0) requireLength("element_texture_place", data.elementPlace, 2 * data.elementPatch.length);
  if (data.elementColour.length > 0) requireLength("element_colour", data.elementColour, data.elementPosition.length);
  const textures = data.header.textures ?? [];
  textures.forEach(({ width, height }, t) => requireLength(`texture_${t}`, data.texture[t]!, 3 * width * height));
  const used = data.header.materials.flatMap((m) => [m.texture, m.emission_texture]).filter((t) => typeof t === "number");
  requireBelow("materials", used, textures.length);
  requireBelow("element_patch", data.elementPatch, n);
  requireBelow("patch_triangle", data.patchTriangle, data.position.length / 3);
  requireBelow("triangle_patch", data.trianglePatch, n);
  requireBelow("triangle_corner", data.triangleCorner, vertices);
  requireBelow("shading_patch", data.shadingPatch, n);
  requireBelow("edge", data.edge, data.position.length / 3);
  requireBelow("surface", data.surface, data.header.surfaces.length);
  requireBelow("node", data.node, k);
  requireBelow("factor_column", data.factorColumn, k);
  if (data.order) requireBelow("order", data.order, k);
  requireBelow("element_triangle", data.elementTriangle, data.elementPosition.length / 3);
}

/** The arrays are views of `buffer`. Throws an Error with one clear line if the data are damaged. */
export function readContainer(buffer: ArrayBuffer): PageData {
  const header = readHeader(buffer);
  const f32 = (name: string) => view(buffer, header, name, "f32");
  const u32 = (name: string) => view(buffer, header, name, "u32");
  const optional = (name: string) => (name in header.arrays ? f32(name) : new Float32Array(0));
  const data: PageData = {
    header,
    position: f32("position"),
    patchTriangle: u32("patch_triangle"),
    trianglePatch: u32("triangle_patch"),
    triangleCorner: u32("triangle_corner"),
    shadingBegin: u32("shading_begin"),
    shadingPatch: u32("shading_patch"),
    shadingWeight: f32("shading_weight"),
    edge: u32("edge"),
    eyePosition: optional("eye_position"),
    eyeNormal: optional("eye_normal"),
    eyeAxis: optional("eye_axis"),
    normal: f32("normal"),
    centroid: f32("centroid"),
    area: f32("area"),
    surface: u32("surface"),
    side: view(buffer, header, "side", "u8"),
    node: u32("node"),
    emission: f32("emission"),
    reflectance: f32("reflectance"),
    irradiance: f32("irradiance"),
    nodeArea: f32("node_area"),
    rowSum: f32("row_sum"),
    lightIrradiance: header.lights.map((_, l) => f32(`light_${l}`)),
    emittedIrradiance: header.materials.map((_, m) => (`emitted_${m}` in header.arrays ? f32(`emitted_${m}`) : null)),
    rowError: f32("row_error"),
    factorBegin: u32("factor_begin"),
    factorColumn: u32("factor_column"),
    factorCode: view(buffer, header, "factor_code", "u16"),
    order: "order" in header.arrays ? u32("order") : null,
    heat: header.heat ? {
      temperature: f32("heat_temperature"), netFlux: f32("heat_net_flux"), irradiance: f32("heat_irradiance"),
      radiosity: f32("heat_radiosity"),
    } : null,
    elementPosition: f32("element_position"),
    elementTriangle: u32("element_triangle"),
    elementIrradiance: f32("element_irradiance"),
    elementPatch: u32("element_patch"),
    elementShare: header.element_lamps.map((_, k) => view(buffer, header, `element_share_${k}`, "u16")),
    elementPlace: optional("element_texture_place"),
    elementColour: "element_colour" in header.arrays ? view(buffer, header, "element_colour", "u16") : new Uint16Array(0),
    texture: (header.textures ?? []).map((_, t) => view(buffer, header, `texture_${t}`, "u8")),
  };
  check(data);
  return data;
}
