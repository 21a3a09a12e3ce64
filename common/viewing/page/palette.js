// Colours of the map and of what lies over it, for dark and for light.

const DARK = ["#24466b", "#2b7a94", "#3aa58c", "#9dbb6b", "#e3c46e", "#f3e3b8"];
const LIGHT = ["#1f3f66", "#226d8b", "#26896f", "#7c9340", "#b98a2b", "#8f5a2e"];
const dark = matchMedia("(prefers-color-scheme: dark)");

/** @param {string} hex */
const parts = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** How many colours a palette has. */
export const SHADES = 64;

/** Whether each vertex tells its colour, not its height. @param {{colour: string}} look */
export const is_by_vertex = (look) => look.colour === "age" || look.colour === "space";

/**
 * SHADES colours as 0xAABBGGRR, as ImageData has them: the lit half first, then what lies below something.
 * @param {string} kind height, age, space or plain
 * @returns {Uint32Array}
 */
export function palette(kind) {
  const stops = (kind === "space" ? space_stops() : dark.matches ? DARK : LIGHT).map(parts);
  const colours = new Uint32Array(2 * SHADES);
  for (let i = 0; i < SHADES; ++i) {
    const at = kind === "plain" ? 2.4 : ((stops.length - 1) * (kind === "age" ? SHADES - 1 - i : i)) / (SHADES - 1);
    const low = Math.min(Math.floor(at), stops.length - 2);
    const colour = stops[low].map((part, c) => part + (stops[low + 1][c] - part) * (at - low));
    colours[i] = packed(colour);
    colours[SHADES + i] = packed(colour.map((part) => part * (dark.matches ? 0.68 : 0.82)));
  }
  return colours;
}

/** Free, from the lowest cells to the highest, then what is occupied. */
const space_stops = () => (dark.matches ? ["#2f8f6c", "#1c4a3c", "#173b31", "#8f98a1", "#c3cad0", "#f2f5f7"]
  : ["#7cc4a6", "#b9dccb", "#cfe6db", "#7c8288", "#4a5157", "#1d2226"]);

/** @param {number[]} colour */
const packed = ([r, g, b]) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;

/** The page's own colour of a name (style.css). @param {string} name */
export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** The background as 0xAABBGGRR. */
export const background = () => packed(parts(css("back")));

/** @param {() => void} changed */
export const on_theme = (changed) => dark.addEventListener("change", changed);
