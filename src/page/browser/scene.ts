// The scene's triangles and lines as the graphics library draws them: patches, elements, outlines.
import {
  BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Group, LineSegments, Mesh,
} from "three";
import type { PageData } from "./container";
import { cornerValues, type PatchLight } from "./light";
import { emissionOfVertices, sortedTriangles, textureGroups, tints, type TextureGroup } from "./textures";
import { lineMaterial, surfaceMaterial, type Uniforms } from "./shading";

export type Surfaces = "smooth" | "flat" | "wireframe";

function dynamic(length: number, size: number): BufferAttribute {
  return new BufferAttribute(new Float32Array(length * size), size).setUsage(DynamicDrawUsage);
}

export class SceneMeshes {
  readonly group = new Group();
  surfaces: Surfaces = "smooth";
  outlines = false;
  readonly hasElements: boolean;

  private readonly patches: Mesh<BufferGeometry>;
  private readonly elements: Mesh;
  private readonly textured: boolean; // elements have textures
  private readonly lines: LineSegments;
  private readonly lineUniforms;
  private light: { now: Float32Array; before: Float32Array };
  private values: { now: Float32Array; before: Float32Array; smooth: boolean };

  constructor(private readonly data: PageData, uniforms: Uniforms) {
    const none = new Float32Array(0);
    this.light = { now: none, before: none };
    this.values = { now: none, before: none, smooth: false };
    this.patches = new Mesh(this.patchGeometry(), surfaceMaterial(uniforms, null));
    const groups = textureGroups(data);
    this.textured = groups.some(({ textures }) => textures);
    this.elements = new Mesh(this.elementGeometry(groups), groups.map(({ textures }) => surfaceMaterial(uniforms, textures)));
    this.hasElements = data.elementTriangle.length > 0;
    const lines = lineMaterial(new Color(0, 0, 0), 0.55);
    this.lineUniforms = lines.uniforms;
    this.lines = new LineSegments(this.lineGeometry(), lines);
    this.group.add(this.patches, this.elements, this.lines);
  }

  /** Radiosity of patches, N*3, now and before. */
  setLight(now: Float32Array, before: Float32Array): void {
    this.light = { now, before };
    this.fill("light", now, 3, this.surfaces === "smooth");
    this.fill("lightBefore", before, 3, this.surfaces === "smooth");
  }

  /** Values of element vertices, for false colour and lines, now and before. */
  setElementValues(now: Float32Array, before: Float32Array): void {
    this.setElements("value", now);
    this.setElements("valueBefore", before);
  }

  /** Light of element vertices, now and before, as FineLight has it, and the light of patches whose emission is theirs. */
  setElementLight(now: Float32Array, before: Float32Array, of: PatchLight, ofBefore: PatchLight): void {
    this.setElements("light", now);
    this.setElements("lightBefore", before);
    if (!this.textured) return;
    this.setElements("own", emissionOfVertices(this.data, of));
    this.setElements("ownBefore", emissionOfVertices(this.data, ofBefore));
  }

  /** Sets the values for false colour, N, now and before; `smooth`: they may be interpolated. */
  setValues(now: Float32Array, before: Float32Array, smooth: boolean): void {
    this.values = { now, before, smooth };
    const interpolated = smooth && this.surfaces === "smooth";
    this.fill("value", now, 1, interpolated);
    this.fill("valueBefore", before, 1, interpolated);
  }

  setSurfaces(surfaces: Surfaces): void {
    this.surfaces = surfaces;
    if (this.light.now.length > 0) this.setLight(this.light.now, this.light.before);
    if (this.values.now.length > 0) this.setValues(this.values.now, this.values.before, this.values.smooth);
  }

  setLineColour(colour: Color): void {
    this.lineUniforms["colour"]!.value = colour;
  }

  /** Chooses the meshes to draw. `elements`: the finer mesh may replace the patches. */
  arrange(elements: boolean): void {
    const wireframe = this.surfaces === "wireframe";
    const fine = elements && this.hasElements && this.surfaces === "smooth";
    this.elements.visible = fine;
    this.patches.visible = !fine && !wireframe;
    this.lines.visible = this.outlines || wireframe;
    this.lineUniforms["opacity"]!.value = wireframe ? 0.9 : 0.45;
  }

  hideLines(): void { this.lines.visible = false; }

  /** The outline of a patch: the edges of its triangles that no other of its triangles has. */
  outlineOf(patch: number): Float32Array {
    const { trianglePatch, patchTriangle, position } = this.data;
    const edges = new Map<string, [number, number]>();
    for (let t = 0; t < trianglePatch.length; ++t) {
      if (trianglePatch[t] !== patch) continue;
      for (let c = 0; c < 3; ++c) {
        const a = patchTriangle[t * 3 + c]!, b = patchTriangle[t * 3 + ((c + 1) % 3)]!;
        const key = a < b ? `${a} ${b}` : `${b} ${a}`;
        if (!edges.delete(key)) edges.set(key, [a, b]);
      }
    }
    const at = (vertex: number) => position.subarray(vertex * 3, vertex * 3 + 3);
    return Float32Array.from([...edges.values()].flatMap(([a, b]) => [...at(a), ...at(b)]));
  }

  private setElements(name: string, values: Float32Array): void {
    const attribute = this.elements.geometry.getAttribute(name) as BufferAttribute;
    attribute.array = values;
    attribute.needsUpdate = true;
  }

  private fill(name: string, values: Float32Array, bands: number, smooth: boolean): void {
    const attribute = this.patches.geometry.getAttribute(name) as BufferAttribute;
    cornerValues(this.data, values, bands, smooth, attribute.array as Float32Array);
    attribute.needsUpdate = true;
  }

  private patchGeometry(): BufferGeometry {
    const { patchTriangle, position } = this.data;
    const corners = new Float32Array(patchTriangle.length * 3);
    patchTriangle.forEach((vertex, k) => corners.set(position.subarray(vertex * 3, vertex * 3 + 3), k * 3));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(corners, 3));
    for (const name of ["light", "lightBefore"]) geometry.setAttribute(name, dynamic(patchTriangle.length, 3));
    for (const name of ["value", "valueBefore"]) geometry.setAttribute(name, dynamic(patchTriangle.length, 1));
    return geometry;
  }

  private elementGeometry(groups: TextureGroup[]): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.data.elementPosition, 3));
    const count = this.data.elementPatch.length;
    for (const name of ["light", "lightBefore"]) geometry.setAttribute(name, dynamic(count, 3));
    for (const name of ["value", "valueBefore"]) geometry.setAttribute(name, dynamic(count, 1));
    if (this.textured) {
      for (const name of ["own", "ownBefore"]) geometry.setAttribute(name, dynamic(count, 3));
      geometry.setAttribute("tint", new BufferAttribute(tints(this.data), 3));
      geometry.setAttribute("place", new BufferAttribute(this.data.elementPlace, 2));
    }
    geometry.setIndex(sortedTriangles(this.data, groups));
    let begin = 0;
    groups.forEach(({ triangles }, k) => {
      geometry.addGroup(begin, 3 * triangles.length, k);
      begin += 3 * triangles.length;
    });
    return geometry;
  }

  private lineGeometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.data.position, 3));
    geometry.setIndex(new BufferAttribute(this.data.edge, 1));
    return geometry;
  }
}
