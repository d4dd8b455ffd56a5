// Colour: the sRGB curve, viridis as in the program's own false-colour pictures, and a map for signed values.
import type { Rgb } from "./container";

/** Every 16th of viridis' 256 published colours, and the last (sRGB); ../../render/colour_map.cpp. */
const VIRIDIS = [
  0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c, 0x1fa088,
  0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725];

const channels = (hex: number): Rgb => [(hex >> 16) & 255, (hex >> 8) & 255, hex & 255];

/** sRGB, 0 to 255. `t` 0 to 1. */
export function viridis(t: number): Rgb {
  const at = (Math.min(1, Math.max(0, t)) * 255) / 16;
  const k = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const end = k + 2 === VIRIDIS.length ? 255 / 16 : k + 1;
  const share = (at - k) / (end - k);
  const low = channels(VIRIDIS[k]!), high = channels(VIRIDIS[k + 1]!);
  return low.map((x, c) => x + share * (high[c]! - x)) as Rgb;
}

/** RdBu of ColorBrewer 2.0, 11 classes, from blue to red (sRGB). */
const RED_BLUE = [
  0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b, 0x67001f];

/** sRGB, 0 to 255. `t` 0 to 1; 0.5 is nearly white. */
export function redBlue(t: number): Rgb {
  const at = Math.min(1, Math.max(0, t)) * (RED_BLUE.length - 1);
  const k = Math.min(Math.floor(at), RED_BLUE.length - 2);
  const low = channels(RED_BLUE[k]!), high = channels(RED_BLUE[k + 1]!);
  return low.map((x, c) => x + (at - k) * (high[c]! - x)) as Rgb;
}

export type ColourMap = (t: number) => Rgb;

/** RGBA bytes of 256 steps. */
export function tableOf(map: ColourMap): Uint8Array {
  const table = new Uint8Array(256 * 4);
  for (let k = 0; k < 256; ++k) table.set([...map(k / 255).map(Math.round), 255], k * 4);
  return table;
}

export const toSrgb = (x: number): number => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
export const fromSrgb = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

/** "#rrggbb" of a linear colour, scaled so that its largest channel is 1. */
export function hexOf(linear: Rgb): string {
  const most = Math.max(...linear);
  const byte = (x: number) => Math.round(255 * toSrgb(most > 0 ? Math.max(0, x / most) : 1));
  return `#${linear.map((x) => byte(x).toString(16).padStart(2, "0")).join("")}`;
}

/** The linear colour of "#rrggbb", its largest channel 1 (black: grey). */
export function chromaOf(hex: string): Rgb {
  const linear = channels(parseInt(hex.slice(1), 16)).map((x) => fromSrgb(x / 255)) as Rgb;
  const most = Math.max(...linear);
  return most > 0 ? (linear.map((x) => x / most) as Rgb) : [1, 1, 1];
}

/** The chromaticity x, y of a black body of 1,667 to 25,000 K (Kim et al., US patent 7,024,034, 2006). */
function planckianXy(kelvin: number): [number, number] {
  const t = 1000 / kelvin;
  const x = kelvin < 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.17991
    : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.24039;
  const y = kelvin < 2222 ? ((-1.1063814 * x - 1.3481102) * x + 2.18555832) * x - 0.20219683
    : kelvin < 4000 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
    : ((3.081758 * x - 5.8733867) * x + 3.75112997) * x - 0.37001483;
  return [x, y];
}

/** The linear colour (Rec. 709) of such a black body, its largest channel 1; what is out of gamut is 0. */
export function planckian(kelvin: number): Rgb {
  const [x, y] = planckianXy(kelvin);
  const [X, Z] = [x / y, (1 - x - y) / y];
  const rgb = [3.2404542 * X - 1.5371385 - 0.4985314 * Z, -0.969266 * X + 1.8760108 + 0.041556 * Z,
               0.0556434 * X - 0.2040259 + 1.0572252 * Z].map((value) => Math.max(0, value));
  return rgb.map((value) => value / Math.max(...rgb)) as Rgb;
}
