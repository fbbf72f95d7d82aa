// The last ten minutes of what the plots show: by the second, and the last minute as it came. Minimum and maximum are kept.

const longestMs = 600_000;
const recentMs = 60_000;

const smaller = (a, b) => (a === null ? b : b === null ? a : Math.min(a, b));
const larger = (a, b) => (a === null ? b : b === null ? a : Math.max(a, b));

function merge(into, later) {
  into.t = later.t;
  into.sigma = later.sigma;
  into.error = [smaller(into.error[0], later.error[0]), larger(into.error[1], later.error[1])];
  into.lanes.forEach((lane, place) => {
    const other = later.lanes[place];
    lane.low = lane.low.map((value, axis) => smaller(value, other.low[axis]));
    lane.high = lane.high.map((value, axis) => larger(value, other.high[axis]));
    lane.bound = other.bound;
  });
  into.states = later.states;
}

/// Smallest and largest magnitude of a range, or null.
export function magnitude(low, high) {
  if (low === null || high === null) return null;
  const most = Math.max(Math.abs(low), Math.abs(high));
  return [low <= 0 && high >= 0 ? 0 : Math.min(Math.abs(low), Math.abs(high)), most];
}

export class Samples {
  seconds = [];
  recent = [];

  add(sample) {
    const last = this.recent.at(-1);
    if (last && (sample.states.length !== last.states.length || sample.t < last.t)) this.seconds = this.recent = [];
    const second = this.seconds.at(-1);
    if (second && Math.floor(second.t / 1000) === Math.floor(sample.t / 1000)) merge(second, sample);
    else this.seconds = [...this.seconds.slice(-longestMs / 1000 + 1), structuredClone(sample)];
    this.recent.push(sample);
    while (this.recent[0].t < sample.t - recentMs) this.recent.shift();
  }

  /// What the server kept from before this page was opened.
  addPast(past) {
    const first = this.seconds[0]?.t ?? Infinity;
    const axes = (this.seconds[0] ?? past.at(-1))?.states.length;
    const earlier = past.filter((sample) => sample.t < first - 1000 && sample.states.length === axes);
    this.seconds = [...earlier, ...this.seconds].slice(-longestMs / 1000);
  }

  /// Oldest first: seconds, and the last minute in full.
  all() {
    const begin = this.recent[0]?.t ?? Infinity;
    return [...this.seconds.filter((second) => second.t < begin), ...this.recent];
  }
}
