// The tables of lanes and of services.
import { number, setText } from "./attitude.js";

const page = (id) => document.getElementById(id);
const standingKinds = { primary: "good", vouches: "good", in: "none", unknown: "none" };
const verdictKinds = { HEALTHY: "good", WARMING_UP: "none", ISOLATED: "warn" };

/// Rows of cells {text, kind?, number?}; cells are reused.
function fill(table, heads, rows) {
  if (!table.tHead) {
    const head = table.createTHead().insertRow();
    for (const [text, isNumber] of heads) {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.textContent = text;
      if (isNumber) cell.className = "number";
      head.append(cell);
    }
    table.createTBody();
  }
  const body = table.tBodies[0];
  while (body.rows.length > rows.length) body.deleteRow(-1);
  rows.forEach((cells, place) => {
    const row = body.rows[place] ?? body.insertRow();
    cells.forEach(({ text, kind }, column) => {
      const cell = row.cells[column] ?? row.insertCell();
      setText(cell, String(text));
      const name = `${heads[column][1] ? "number " : ""}${kind ?? ""}`.trim();
      if (cell.className !== name) cell.className = name;
    });
  });
}

export function showLanes(state) {
  const rows = state.lanes.map((lane) => [
    { text: lane.name },
    { text: lane.standing, kind: standingKinds[lane.standing] ?? "bad" },
    { text: lane.verdict, kind: verdictKinds[lane.verdict] ?? "bad" },
    { text: number(lane.statistic) },
    { text: number(lane.threshold) },
  ]);
  fill(page("lanes"), [["lane"], ["voter's view"], ["verdict"], ["statistic", true], ["threshold", true]], rows);
}

export function showServices(state) {
  const microseconds = (value) => (value === null ? "–" : (value * 1e6).toFixed(0));
  const services = [...state.services].sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  const rows = services.map((service) => {
    const silent = service.age_s > 2 || service.state === "STOPPING";
    return [
      { text: service.name },
      { text: silent ? "silent" : service.state.toLowerCase(), kind: silent ? "bad" : "good" },
      { text: service.vendor },
      { text: service.transport },
      { text: silent ? "–" : number(service.rate_hz, 4) },
      { text: microseconds(service.latency_p50_s) },
      { text: microseconds(service.latency_p99_s) },
      { text: service.gaps, kind: service.gaps ? "warn" : "" },
      { text: service.late, kind: service.late ? "warn" : "" },
      { text: service.restarts, kind: service.restarts ? "warn" : "" },
    ];
  });
  const heads = [["service"], ["state"], ["vendor"], ["transport"], ["Hz", true], ["p50 µs", true], ["p99 µs", true], ["gaps", true], ["late", true], ["restarts", true]];
  fill(page("services"), heads, rows);
}
