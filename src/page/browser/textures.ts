// Textures and colours of vertices: they multiply the light of elements, texel by texel.
import {
  BufferAttribute, ClampToEdgeWrapping, DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, RGBAFormat,
  SRGBColorSpace,
} from "three";
import type { MaterialInfo, PageData } from "./container";
import type { PatchLight } from "./light";

const BANDS = 3;
const WHOLE = 65535; // of a colour
const SHARPNESS = 8; // anisotropy: texels of a floor that is seen from aside

const isTextured = ({ texture, emission_texture }: MaterialInfo): boolean =>
  typeof texture === "number" || typeof emission_texture === "number";

/** Which materials have textures, or colours at their vertices, so that elements' light is multiplied. */
export function varyingMaterials(data: PageData): boolean[] {
  const varying = data.header.materials.map(isTextured);
  for (let at = 0; at < data.elementColour.length; ++at) {
    if (data.elementColour[at] !== WHOLE) varying[materialOf(data, Math.floor(at / BANDS))] = true;
  }
  return varying;
}

const materialOf = (data: PageData, vertex: number): number =>
  data.header.surfaces[data.surface[data.elementPatch[vertex]!]!]!.material;

/** What multiplies the light and the texture at vertices of elements, Q*3. */
export function tints(data: PageData): Float32Array {
  const result = new Float32Array(data.elementPosition.length);
  for (let at = 0; at < result.length; ++at) {
    const factor = data.header.materials[materialOf(data, Math.floor(at / BANDS))]!.factor[at % BANDS]!;
    result[at] = data.elementColour.length > 0 ? (factor * data.elementColour[at]!) / WHOLE : factor;
  }
  return result;
}

/** The emission of vertices, Q*3, that the texture of emission multiplies where there is one. */
export function emissionOfVertices(data: PageData, light: PatchLight): Float32Array {
  const { materials, textures } = data.header;
  const result = new Float32Array(data.elementPosition.length);
  for (let at = 0; at < result.length; ++at) {
    const b = at % BANDS, v = (at - b) / BANDS, of = data.elementPatch[v]! * BANDS + b;
    const { emission_texture: texture, emission_factor: factor } = materials[materialOf(data, v)]!;
    const then = data.emission[of]!, now = light.emission[of]!;
    result[at] = typeof texture !== "number" ? now : then > 0 ? (now / then) * factor[b]! * textures![texture]!.scale : 0;
  }
  return result;
}

/** A texture as the graphics library takes it; sRGB, decoded by the GPU. */
function textureOf(data: PageData, number: number | null | undefined): DataTexture {
  const { width, height, repeat } = typeof number === "number" ? data.header.textures![number]!
    : { width: 1, height: 1, repeat: true };
  const coded = typeof number === "number" ? data.texture[number]! : Uint8Array.of(255, 255, 255);
  const pixels = new Uint8Array(width * height * 4).fill(255);
  for (let k = 0; k < width * height; ++k) {
    for (let b = 0; b < BANDS; ++b) {
      // Each is stored less the one to its left.
      pixels[4 * k + b] = coded[BANDS * k + b]! + (k % width === 0 ? 0 : pixels[4 * (k - 1) + b]!);
    }
  }
  const texture = new DataTexture(pixels, width, height, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = repeat ? RepeatWrapping : ClampToEdgeWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = SHARPNESS;
  texture.needsUpdate = true;
  return texture;
}

/** Triangles of elements that are drawn with the same textures; null: with none, nor colours of vertices. */
export interface TextureGroup {
  triangles: number[];
  textures: { texels: DataTexture; emissionTexels: DataTexture } | null;
}

export function textureGroups(data: PageData): TextureGroup[] {
  const varying = varyingMaterials(data);
  const groups = new Map<string, TextureGroup>();
  const made = new Map<number | null | undefined, DataTexture>();
  const once = (number: number | null | undefined) => {
    if (!made.has(number)) made.set(number, textureOf(data, number));
    return made.get(number)!;
  };
  for (let t = 0; t < data.elementTriangle.length / 3; ++t) {
    const m = materialOf(data, data.elementTriangle[3 * t]!);
    const { texture, emission_texture: emission } = data.header.materials[m]!;
    const key = varying[m] ? `${texture} ${emission}` : "";
    let group = groups.get(key);
    if (!group) {
      const textures = varying[m] ? { texels: once(texture), emissionTexels: once(emission) } : null;
      groups.set(key, group = { triangles: [], textures });
    }
    group.triangles.push(t);
  }
  return [...groups.values()];
}

/** The triangles of the groups, one group after the other. */
export function sortedTriangles(data: PageData, groups: TextureGroup[]): BufferAttribute {
  const sorted = new Uint32Array(data.elementTriangle.length);
  let at = 0;
  for (const { triangles } of groups) {
    for (const t of triangles) {
      sorted.set(data.elementTriangle.subarray(3 * t, 3 * t + 3), at);
      at += 3;
    }
  }
  return new BufferAttribute(sorted, 1);
}
