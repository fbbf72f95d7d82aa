// A tile per axis, in the group of its instrument: name, state in words, what the lanes report, the last minute of its residual.
import { angle, setText } from "./attitude.js";
import { magnitude } from "./samples.js";

const page = (id) => document.getElementById(id);
const kinds = { healthy: "good", degraded: "warn", suspect: "warn", saturated: "other", absent: "other", "left out": "warn", isolated: "bad", "no data": "none" };
const marks = { healthy: "✓", degraded: "≈", suspect: "?", saturated: "▲", absent: "∅", "left out": "◐", isolated: "✕", "no data": "–" };
const units = { bias: "rad/s", gain: "×", sign: "×", delay: "s", noise: "×", spikes: "rad/s", mounting: "rad" };
let tiles = [];
let chosen = 0;
let byHand = false;

export const selected = () => chosen;

function select(axis) {
  chosen = axis;
  tiles.forEach((tile, place) => tile.button.setAttribute("aria-pressed", String(place === chosen)));
}

function makeTile(axis) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "tile";
  button.id = `axis-${axis.axis}`;
  const parts = ["b", "span", "span", "canvas"].map((name) => button.appendChild(document.createElement(name)));
  parts[2].className = "lanes";
  parts[3].setAttribute("aria-hidden", "true");
  parts[0].textContent = axis.name;
  button.addEventListener("click", () => {
    byHand = true;
    select(axis.axis);
  });
  return { button, state: parts[1], lanes: parts[2], canvas: parts[3] };
}

function rebuild(axes) {
  const groups = new Map();
  tiles = axes.map((axis) => {
    const tile = makeTile(axis);
    if (!groups.has(axis.instrument)) {
      const group = document.createElement("div");
      group.className = "instrument";
      groups.set(axis.instrument, group);
    }
    groups.get(axis.instrument).append(tile.button);
    return tile;
  });
  page("tiles").replaceChildren(...groups.values());
  select(Math.min(chosen, Math.max(0, axes.length - 1)));
}

function details(axis, laneNames) {
  if (axis.diagnosis) return `${axis.diagnosis.what} ${axis.diagnosis.size?.toPrecision(3) ?? ""} ${units[axis.diagnosis.what] ?? ""}`;
  const told = laneNames.filter((_, place) => !["healthy", "no data"].includes(axis.lanes[place]));
  return told.length ? `lanes ${told.join(", ")}` : "";
}

export function showTiles(state) {
  const names = state.axes.map((axis) => axis.name).join();
  if (page("tiles").dataset.names !== names) {
    page("tiles").dataset.names = names;
    rebuild(state.axes);
  }
  const laneNames = state.lanes.map((lane) => lane.name);
  state.axes.forEach((axis, place) => {
    const tile = tiles[place];
    setText(tile.state, `${marks[axis.state]} ${axis.state}`);
    const kind = `state ${kinds[axis.state]}`;
    if (tile.state.className !== kind) {
      tile.state.className = kind;
      tile.button.dataset.state = axis.state;
    }
    setText(tile.lanes, details(axis, laneNames));
  });
  // What changed is what somebody wants to see, unless they have chosen.
  const worst = state.axes.findIndex((axis) => axis.state === "isolated");
  if (!byHand && worst >= 0 && worst !== chosen) select(worst);
}

/// The largest residual of any lane in units of its bound: one bar per sample, the bound at half height.
export function drawSparks(samples) {
  const style = getComputedStyle(document.documentElement);
  const colours = { bar: style.getPropertyValue("--lane0"), over: style.getPropertyValue("--bad"), line: style.getPropertyValue("--faint") };
  const recent = samples.recent;
  tiles.forEach((tile, axis) => {
    const canvas = tile.canvas;
    if (canvas.width !== 240) Object.assign(canvas, { width: 240, height: 60 });
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, 240, 60);
    const end = recent.at(-1)?.t ?? 0;
    for (const sample of recent) {
      const ratio = Math.max(...sample.lanes.map((lane) => ratioOf(lane, axis)));
      if (!(ratio >= 0)) continue;
      const height = Math.max(2, Math.min(2, ratio) * 30);
      context.fillStyle = ratio > 1 ? colours.over : colours.bar;
      context.fillRect(240 - (end - sample.t) / 250, 60 - height, 2, height);
    }
    context.fillStyle = colours.line;
    context.fillRect(0, 29, 240, 1);
    const bound = recent.at(-1)?.lanes[0]?.bound[axis];
    tile.button.title = bound ? `half height is the bound: ${angle(bound)} in one frame` : "";
  });
}

function ratioOf(lane, axis) {
  const range = magnitude(lane.low[axis], lane.high[axis]);
  return range && lane.bound[axis] > 0 ? range[1] / lane.bound[axis] : -1;
}
