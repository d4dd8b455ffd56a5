// Hemicubes on the viewer's GPU: a strip of five faces for each of many eyes in one picture of floats,
// multiplied by delta form factors and summed to one texel an eye. WebGL 2 with EXT_color_buffer_float.
import type { PageData } from "./container";
import { Chunks } from "./gather_chunks";
import type { Eyes } from "./gather_eyes";
import { ADD, DRAW, ROWS, WHOLE } from "./gather_shaders";
import { deltaFormFactors, stripRows } from "./gather_weights";
import { drawn, drawsInSoftware } from "./graphics";

const ATLAS_WIDTH = 2048, ATLAS_HEIGHT = 1536; // pixels; 63 MB with its depths
const CHUNK = 16; // triangles, in software: more draws cost what fewer vertices save
const RESULT_WIDTH = 256; // eyes a row of the texture that collects a pass
// In diagonals of the scene. Positions are floats, with errors of up to 1e-7. An eye is lifted
// above its own plane, so that it does not see it. Backs are moved behind fronts by more than the
// error, so that the front of a plate without thickness is seen.
const LIFT = 1e-6, NEAR = 1e-6, BACK = 4e-6;
type Vec = [number, number, number];

const minus = (a: Vec): Vec => [-a[0], -a[1], -a[2]];
const cross = (a: Vec, b: Vec): Vec =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** A target to draw into and the texture that it fills. */
interface Target {
  frame: WebGLFramebuffer;
  texture: WebGLTexture;
}

export class GatherGpu {
  /** Whether software draws, not a GPU. */
  readonly software: boolean;
  readonly capacity: number; // eyes a batch, at most
  private readonly gl: WebGL2RenderingContext;
  private readonly columns: number;
  private readonly rows: number; // of a strip
  private readonly draw: WebGLProgram;
  private readonly reduceRows: WebGLProgram;
  private readonly add: WebGLProgram;
  private readonly atlas: Target;
  private readonly sums: Target;
  private readonly result: Target;
  private readonly weights: WebGLTexture;
  private readonly scene: WebGLVertexArrayObject;
  private readonly none: WebGLVertexArrayObject;
  private readonly light: WebGLBuffer;
  private readonly resultRows: number;
  private readonly chunks: Chunks;
  private brightest = 0;

  /** Throws an Error with one sentence if the browser cannot gather. */
  constructor(private readonly data: PageData, private readonly eyes: Eyes, readonly resolution: number) {
    const gl = document.createElement("canvas").getContext("webgl2", { antialias: false, depth: false, alpha: false });
    if (!gl) throw new Error("Gathering needs WebGL 2, which this browser does not offer.");
    if (!gl.getExtension("EXT_color_buffer_float")) {
      throw new Error(
        "Gathering needs pictures of 32-bit floats (EXT_color_buffer_float), which this GPU does not draw.");
    }
    this.gl = gl;
    this.software = drawsInSoftware(gl);
    this.chunks = new Chunks(data, this.software ? CHUNK : Infinity);
    this.rows = stripRows(resolution);
    this.columns = ATLAS_WIDTH / resolution;
    this.capacity = this.columns * Math.floor(ATLAS_HEIGHT / this.rows);
    this.resultRows = Math.ceil(eyes.count / RESULT_WIDTH);
    this.draw = this.program(DRAW.vertex, DRAW.fragment);
    this.reduceRows = this.program(WHOLE, ROWS);
    this.add = this.program(WHOLE, ADD);
    this.atlas = this.target(ATLAS_WIDTH, ATLAS_HEIGHT, true);
    this.sums = this.target(this.capacity, this.rows, false);
    this.result = this.target(RESULT_WIDTH, this.resultRows, false);
    this.weights = this.texture(gl.R32F, resolution, this.rows);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, resolution, this.rows, gl.RED, gl.FLOAT, deltaFormFactors(resolution));
    this.light = gl.createBuffer();
    this.none = gl.createVertexArray();
    this.scene = this.sceneArrays();
  }

  dispose(): void { this.gl.getExtension("WEBGL_lose_context")?.loseContext(); }

  /** Sets the radiosity at the corners of triangles, T*9, that eyes see from now on. */
  setLight(corners: Float32Array): void {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.light);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, corners, this.gl.DYNAMIC_DRAW);
    this.brightest = corners.reduce((most, value) => Math.max(most, value), 0);
  }

  /** Starts the looks of `count` eyes from `first` on, fewer at the end of a row of the result; returns their number. */
  look(first: number, count: number, sky: Vec): number {
    const column = first % RESULT_WIDTH;
    const looks = Math.min(count, this.capacity, RESULT_WIDTH - column, this.eyes.count - first);
    this.drawHemicubes(first, looks, sky);
    const { gl } = this;
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.none);
    this.reduce(this.reduceRows, this.sums, [0, 0, looks, this.rows],
                { atlas: this.atlas.texture, weights: this.weights },
                { resolution: this.resolution, columns: this.columns });
    this.reduce(this.add, this.result, [column, Math.floor(first / RESULT_WIDTH), looks, 1],
                { sums: this.sums.texture }, { rows: this.rows, first: column });
    return looks;
  }

  /** Resolves when all looks are done. */
  async done(): Promise<void> {
    if (!(await drawn(this.gl))) throw new Error("The GPU gave up on gathering; start again.");
  }

  /** The results of every eye, G*4: irradiance, and the sum of its weights; of eyes to come those of the pass before. */
  async read(): Promise<Float32Array> {
    const values = await this.pixels(this.result, [0, 0, RESULT_WIDTH, this.resultRows]);
    return values.subarray(0, this.eyes.count * 4);
  }

  /** The strip of look k of the last batch: rows of `resolution` pixels of four floats. */
  strip(k: number): Promise<Float32Array> {
    const { columns, resolution, rows } = this;
    return this.pixels(this.atlas, [(k % columns) * resolution, Math.floor(k / columns) * rows, resolution, rows]);
  }

  private async pixels(of: Target, at: [number, number, number, number]): Promise<Float32Array> {
    const { gl } = this;
    const values = new Float32Array(at[2] * at[3] * 4);
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, values.byteLength, gl.STREAM_READ);
    gl.bindFramebuffer(gl.FRAMEBUFFER, of.frame);
    gl.readPixels(...at, gl.RGBA, gl.FLOAT, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    await this.done();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, values);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.deleteBuffer(buffer);
    return values;
  }

  private drawHemicubes(first: number, looks: number, sky: Vec): void {
    const { gl, draw, columns, resolution, rows } = this;
    const size = this.data.header.diagonal;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.atlas.frame);
    gl.enable(gl.DEPTH_TEST);
    gl.frontFace(gl.CW); // faces are seen from within: mirrored
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, 0, Math.min(looks, columns) * resolution, Math.ceil(looks / columns) * rows);
    gl.clearColor(Math.PI * sky[0], Math.PI * sky[1], Math.PI * sky[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.SCISSOR_TEST);
    gl.useProgram(draw);
    gl.bindVertexArray(this.scene);
    gl.uniform1f(gl.getUniformLocation(draw, "nearest"), NEAR * size);
    gl.uniform1f(gl.getUniformLocation(draw, "brightest"), this.brightest);
    gl.uniform2f(gl.getUniformLocation(draw, "depths"), 1 / (1.01 * size), BACK / 1.01);
    const at = ["eye", "across", "up", "along"].map((name) => gl.getUniformLocation(draw, name));
    const half = gl.getUniformLocation(draw, "half_");
    for (let k = 0; k < looks; ++k) {
      const normal = this.eyes.normal(first + k), s = this.eyes.axis(first + k), t = cross(normal, s);
      if (Math.hypot(...normal) === 0) continue; // represents no area
      const eye = this.eyes.position(first + k).map((x, d) => x + LIFT * size * normal[d]!) as Vec;
      gl.uniform3f(at[0]!, ...eye);
      const faces: [Vec, Vec, Vec][] =
        [[s, t, normal], [t, normal, s], [minus(s), normal, t], [minus(t), normal, minus(s)], [s, normal, minus(t)]];
      const left = (k % columns) * resolution, bottom = Math.floor(k / columns) * rows;
      faces.forEach(([across, up, along], face) => {
        [across, up, along].forEach((axis, d) => gl.uniform3f(at[d + 1]!, ...axis));
        gl.uniform1i(half, face > 0 ? 1 : 0);
        gl.viewport(left, bottom + (face > 0 ? resolution + ((face - 1) * resolution) / 2 : 0), resolution,
                    face > 0 ? resolution / 2 : resolution);
        this.chunks.seen(eye, { across, up, along, half: face > 0 },
                         (first, count) => gl.drawArrays(gl.TRIANGLES, first, count));
      });
    }
  }

  private reduce(program: WebGLProgram, into: Target, at: [number, number, number, number],
                 textures: Record<string, WebGLTexture>, numbers: Record<string, number>): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, into.frame);
    gl.viewport(...at);
    gl.useProgram(program);
    Object.entries(textures).forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(gl.getUniformLocation(program, name), unit);
    });
    for (const [name, value] of Object.entries(numbers)) gl.uniform1i(gl.getUniformLocation(program, name), value);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    for (let unit = 0; unit < 2; ++unit) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, null); // the next target must not be read
    }
  }

  private sceneArrays(): WebGLVertexArrayObject {
    const { gl } = this;
    const { patchTriangle, position } = this.data;
    const corners = new Float32Array(patchTriangle.length * 3);
    patchTriangle.forEach((vertex, k) => corners.set(position.subarray(vertex * 3, vertex * 3 + 3), k * 3));
    const arrays = gl.createVertexArray();
    gl.bindVertexArray(arrays);
    [gl.createBuffer(), this.light].forEach((buffer, place) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    });
    gl.bindVertexArray(null);
    return arrays;
  }

  private texture(format: number, width: number, height: number): WebGLTexture {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    return texture;
  }

  private target(width: number, height: number, depths: boolean): Target {
    const { gl } = this;
    const texture = this.texture(gl.RGBA32F, width, height);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    if (depths) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, buffer);
    }
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) {
      throw new Error("Gathering needs more memory than this GPU gives a page.");
    }
    return { frame, texture };
  }

  private program(vertex: string, fragment: string): WebGLProgram {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(type)!;
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error(`This GPU does not take the shaders of gathering: ${gl.getProgramInfoLog(program)}`);
    }
    return program;
  }
}
