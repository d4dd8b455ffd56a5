// The colours on the screen: exposure, tone mapping, false colour. The graphics library does no
// lighting; the light is the radiosity at the corners of triangles.
import {
  ClampToEdgeWrapping, Color, DataTexture, LinearFilter, RGBAFormat, ShaderMaterial, type IUniform,
} from "three";
import { tableOf, viridis, type ColourMap } from "./colour";

export type Tone = "linear" | "reinhard" | "filmic";
const TONES: Tone[] = ["linear", "reinhard", "filmic"];

export interface Uniforms {
  [name: string]: IUniform;
  exposure: IUniform<number>; // EV
  tone: IUniform<number>;
  showValue: IUniform<boolean>; // false colour
  logarithmic: IUniform<boolean>;
  low: IUniform<number>;
  high: IUniform<number>;
  map: IUniform<DataTexture>;
  lineStep: IUniform<number>; // of isolines; 0: none
  before: IUniform<boolean>; // the light before, not as it is now
  measured: IUniform<boolean>; // values instead of colours
}

export function mapTexture(map: ColourMap): DataTexture {
  const texture = new DataTexture(tableOf(map), 256, 1, RGBAFormat);
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.wrapS = ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}

export function makeUniforms(): Uniforms {
  return {
    exposure: { value: 0 }, tone: { value: 0 }, showValue: { value: false }, logarithmic: { value: false },
    low: { value: 0 }, high: { value: 1 }, map: { value: mapTexture(viridis) }, lineStep: { value: 0 },
    before: { value: false }, measured: { value: false },
  };
}

export const toneIndex = (tone: Tone): number => TONES.indexOf(tone);

// Converts radiosity to display values. `linear` gives the same as the program's PNG files.
const DISPLAY = /* glsl */ `
  uniform float exposure;
  uniform int tone;
  vec3 filmic(vec3 x) {  // ACES, fitted by Narkowicz 2015
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  }
  vec3 display(vec3 radiosity) {
    vec3 x = max(radiosity, 0.0) / 3.14159265358979 * exp2(exposure);
    if (tone == 1) x /= 1.0 + dot(x, vec3(0.2126, 0.7152, 0.0722));  // Reinhard et al. 2002
    if (tone == 2) x = filmic(x);
    x = clamp(x, 0.0, 1.0);
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
  }
`;

// A value's colour, and lines where it is a multiple of a step, about a pixel and a half wide. Where lines would meet,
// as on a lamp, there are none.
const VALUES = /* glsl */ `
  uniform bool showValue, logarithmic;
  uniform float low, high, lineStep;
  uniform sampler2D map;
  varying float vValue;
  vec3 falseColour(vec3 shown) {
    if (vValue < -1e29) return vec3(0.45);
    if (logarithmic && vValue <= 0.0) { // grey, with a hint of the light, which shows what is where
      return vec3(0.12 + 0.25 * dot(shown, vec3(0.2126, 0.7152, 0.0722)));
    }
    float t = logarithmic ? log(max(vValue, 1e-30) / low) / log(high / low) : (vValue - low) / (high - low);
    return texture2D(map, vec2(clamp(t, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  }
  vec3 withLine(vec3 shown) {
    float along = vValue / lineStep;
    float slope = fwidth(along);
    float pixels = abs(along - floor(along + 0.5)) / max(slope, 1e-12);
    float share = (1.0 - smoothstep(0.4, 1.2, pixels)) * (1.0 - smoothstep(0.1, 0.3, slope));
    if (vValue < 0.5 * lineStep) share = 0.0;
    return mix(shown, vec3(step(dot(shown, vec3(0.2126, 0.7152, 0.0722)), 0.4)), 0.75 * share);
  }
`;

/**
 * Triangles with their light: attributes light, lightBefore (vec3, W/m^2), and what false colours and lines show of
 * them: value, valueBefore. With textures, light is what these and `tint` multiply, and `own`, `ownBefore` are emission;
 * `place`: texture coordinates.
 */
export function surfaceMaterial(
  uniforms: Uniforms, textures: { texels: DataTexture; emissionTexels: DataTexture } | null): ShaderMaterial {
  const own = textures ? { texels: { value: textures.texels }, emissionTexels: { value: textures.emissionTexels } } : {};
  return new ShaderMaterial({
    uniforms: { ...uniforms, ...own },
    defines: textures ? { TEXTURED: "" } : {},
    toneMapped: false,
    polygonOffset: true, // outlines lie on top
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      attribute vec3 light, lightBefore;
      attribute float value, valueBefore;
      uniform bool before;
      varying vec3 vLight;
      varying float vValue;
      #ifdef TEXTURED
        attribute vec3 tint, own, ownBefore;
        attribute vec2 place;
        varying vec3 vTint, vOwn;
        varying vec2 vPlace;
      #endif
      void main() {
        vLight = before ? lightBefore : light;
        vValue = before ? valueBefore : value;
        #ifdef TEXTURED
          vTint = tint;
          vOwn = before ? ownBefore : own;
          vPlace = place;
        #endif
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      ${DISPLAY}
      ${VALUES}
      uniform bool measured;
      varying vec3 vLight;
      #ifdef TEXTURED
        uniform sampler2D texels, emissionTexels;
        varying vec3 vTint, vOwn;
        varying vec2 vPlace;
        vec3 radiosity() {
          return vOwn * texture2D(emissionTexels, vPlace).rgb + vTint * texture2D(texels, vPlace).rgb * vLight;
        }
      #else
        vec3 radiosity() { return vLight; }
      #endif
      void main() {
        vec3 shown = display(radiosity());
        if (showValue) shown = falseColour(shown);
        if (lineStep > 0.0) shown = withLine(shown);
        gl_FragColor = measured ? vec4(vValue, 0.0, 0.0, 1.0) : vec4(shown, 1.0);
      }`,
  });
}

/** Lines in one colour as given (sRGB). */
export function lineMaterial(colour: Color, opacity: number): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { colour: { value: colour }, opacity: { value: opacity } },
    transparent: true,
    toneMapped: false,
    depthWrite: false,
    vertexShader: `void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
    fragmentShader: `
      uniform vec3 colour;
      uniform float opacity;
      void main() { gl_FragColor = vec4(colour, opacity); }`,
  });
}
