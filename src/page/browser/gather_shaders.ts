// Shaders of gathering. One face of a hemicube looks along `along`; points keep their distances along that axis, so the
// picture lies at distance 1. A strip of rows: the top face, then the upper halves of four sides.

/** The scene as one face sees it; backs are black. */
export const DRAW = {
  vertex: `#version 300 es
    layout(location = 0) in vec3 position;
    layout(location = 1) in vec3 light;
    uniform vec3 eye, across, up, along;
    uniform bool half_; // a side: only what is above the horizon
    uniform float nearest;
    out vec3 vLight;
    out float vDistance;
    flat out vec4 vCorner;
    void main() {
      vec3 p = position - eye;
      float w = dot(p, along), y = dot(p, up);
      vLight = light;
      vDistance = w;
      vCorner = vec4(light, w);
      gl_Position = vec4(dot(p, across), half_ ? 2.0 * y - w : y, w - 2.0 * nearest, w);
    }`,
  // Depths are linear in the distance, with the rounding error of a float everywhere. By rounding,
  // a triangle seen almost edge-on may cover a pixel where interpolation divides by 0: it shows the
  // value of its last corner.
  fragment: `#version 300 es
    precision highp float;
    uniform vec2 depths; // a unit of distance; how far backs lie behind
    uniform float brightest; // of all corners
    in vec3 vLight;
    in float vDistance;
    flat in vec4 vCorner;
    out vec4 colour;
    void main() {
      bool sound = vDistance * depths.x <= 1.0 && all(greaterThanEqual(vLight, vec3(-0.001 * brightest))) &&
                   all(lessThanEqual(vLight, vec3(1.001 * brightest)));
      vec4 shown = sound ? vec4(vLight, vDistance) : vCorner;
      colour = vec4(gl_FrontFacing ? shown.rgb : vec3(0.0), 1.0);
      gl_FragDepth = clamp(shown.a * depths.x + (gl_FrontFacing ? 0.0 : depths.y), 0.0, 0.9999999);
    }`,
};

/** One triangle over all of the target. */
export const WHOLE = `#version 300 es
  void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

/** Column: an eye; row: the weighted sum of a row of its strip. */
export const ROWS = `#version 300 es
  precision highp float;
  uniform highp sampler2D atlas, weights;
  uniform int resolution, columns;
  out vec4 sum;
  void main() {
    int eye = int(gl_FragCoord.x), row = int(gl_FragCoord.y);
    ivec2 corner = ivec2((eye % columns) * resolution, (eye / columns) * 3 * resolution);
    sum = vec4(0.0);
    for (int x = 0; x < resolution; ++x) {
      sum += texelFetch(weights, ivec2(x, row), 0).r * texelFetch(atlas, corner + ivec2(x, row), 0);
    }
  }`;

/** The sum of an eye's rows. */
export const ADD = `#version 300 es
  precision highp float;
  uniform highp sampler2D sums;
  uniform int rows, first;
  out vec4 sum;
  void main() {
    int eye = int(gl_FragCoord.x) - first;
    sum = vec4(0.0);
    for (int row = 0; row < rows; ++row) sum += texelFetch(sums, ivec2(eye, row), 0);
  }`;
