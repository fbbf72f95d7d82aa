// The residual of the selected axis by lane against its bound, and the attitude's standard deviation and error, with dygraphs.
import { magnitude } from "./samples.js";

const page = (id) => document.getElementById(id);
let residual = null;
let error = null;
let built = "";
let onTouch = () => {};

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const laneColour = (place) => colour(`--lane${place % 4}`);
const scientific = (value, digits) => (value === 0 ? "0" : value.toExponential(digits));
const errorLabels = ["standard deviation of the attitude, rad", "its error against the truth, rad"];
const leastSpanMs = 20_000; // of the plots, where the run is younger than the chosen time
const flat = (value) => [value, value, value];

/// A range as the charts take it: [smallest, middle, largest]. A logarithmic axis has no 0: three decades below the largest stand for it.
function bar(range) {
  if (!range) return [null, null, null];
  const low = page("logarithmic").checked ? Math.max(range[0], range[1] / 1000) : range[0];
  return [low, (low + range[1]) / 2, range[1]];
}

/// One row per sample: time, then per lane its residual as [smallest, middle, largest] and its bound.
function residualRows(all, lanes, axis) {
  return all.map((sample) => {
    const cells = lanes.flatMap((_, place) => {
      const lane = sample.lanes[place];
      const range = lane && magnitude(lane.low[axis] ?? null, lane.high[axis] ?? null);
      return [bar(range), flat(lane?.bound[axis] ?? null)];
    });
    return [new Date(sample.t), ...cells];
  });
}

function errorRows(all) {
  return all.map((sample) => {
    const [low, high] = sample.error;
    return [new Date(sample.t), flat(sample.sigma), bar(high === null ? null : [low, high])];
  });
}

function options(labels, colours, dashed, legend) {
  const series = {};
  for (const name of dashed) series[name] = { strokePattern: [6, 4], strokeWidth: 1 };
  return {
    labels, colors: colours, series, customBars: true, legend: "always", labelsDiv: page(legend),
    axisLineColor: colour("--faint"), gridLineColor: colour("--line"), rangeSelectorAlpha: 0.3, logscale: page("logarithmic").checked,
    axes: {
      x: { axisLabelWidth: 76, pixelsPerLabel: 96 },
      y: { valueFormatter: (value) => scientific(value, 2), axisLabelFormatter: (value) => scientific(value, 0), axisLabelWidth: 56 },
    },
    zoomCallback: () => onTouch(), animatedZooms: false,
  };
}

function build(all, lanes, axis, state) {
  residual?.destroy();
  error?.destroy();
  const labels = ["time", ...lanes.flatMap((name) => [`lane ${name}`, `bound ${name}`])];
  const colours = lanes.flatMap((_, place) => [laneColour(place), laneColour(place)]);
  const bounds = lanes.map((name) => `bound ${name}`);
  residual = new Dygraph(page("plot"), residualRows(all, lanes, axis), { ...options(labels, colours, bounds, "plot-legend"), showRangeSelector: true });
  error = new Dygraph(page("error-plot"), errorRows(all), options(["time", ...errorLabels], [colour("--bound"), laneColour(1)], [errorLabels[0]], "error-legend"));
  page("plot-title").textContent = `Residual of ${state.axes[axis].name}, ${state.kind === "accelerometer" ? "m/s" : "rad"} per frame`;
}

/// @param touched  called when somebody zooms, so that the plot does not run away from them.
export function startPlots(touched) {
  onTouch = touched;
  for (const id of ["logarithmic", "span"]) page(id).addEventListener("change", () => (built = ""));
  if (typeof Dygraph === "undefined") page("plot-hint").textContent = "There are no plots: the package libjs-dygraphs is not installed where this page comes from.";
}

export function drawPlots(samples, state, axis, anew = false) {
  if (anew) built = "";
  if (!state || typeof Dygraph === "undefined" || !state.axes[axis]) return;
  const lanes = state.lanes.map((lane) => lane.name);
  const all = samples.all();
  if (!all.length) return;
  const wanted = [axis, state.axes[axis].name, ...lanes].join();
  if (wanted !== built) build(all, lanes, axis, state);
  built = wanted;
  const end = all.at(-1).t;
  const dateWindow = [Math.max(end - 1000 * Number(page("span").value), Math.min(all[0].t, end - leastSpanMs)), end];
  residual.updateOptions({ file: residualRows(all, lanes, axis), dateWindow });
  page("error-plot").hidden = !state.has_attitude;
  if (state.has_attitude) error.updateOptions({ file: errorRows(all), dateWindow });
}
