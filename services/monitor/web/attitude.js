// The artificial horizon and the figures beside it.

const page = (id) => document.getElementById(id);
const pixelsPerDegree = 3;

export function number(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  return size < 1e-3 || size >= 1e6 ? value.toExponential(digits - 1) : value.toPrecision(digits);
}

const degrees = (value) => (value === undefined || value === null ? "–" : `${value.toFixed(2)}°`);

/// An angle in a unit that reads well.
export function angle(radians) {
  if (radians === null || radians === undefined) return "–";
  const value = Math.abs(radians);
  if (value >= 1e-2) return `${((radians * 180) / Math.PI).toPrecision(3)}°`;
  return value >= 1e-3 ? `${(radians * 1e3).toPrecision(3)} mrad` : `${(radians * 1e6).toPrecision(3)} µrad`;
}

export function showAttitude(state) {
  const attitude = state.attitude;
  const euler = attitude?.euler_deg;
  page("no-attitude").textContent = euler ? "" : "no attitude";
  page("horizon").setAttribute(
    "aria-label",
    euler ? `artificial horizon: roll ${degrees(euler.roll)}, pitch ${degrees(euler.pitch)}, yaw ${degrees(euler.yaw)}` : "artificial horizon: no attitude",
  );
  if (euler)
    page("horizon-turn").setAttribute("transform", `rotate(${(-euler.roll).toFixed(2)}) translate(0 ${(euler.pitch * pixelsPerDegree).toFixed(2)})`);
  const rows = [
    ["roll", degrees(euler?.roll)],
    ["pitch", degrees(euler?.pitch)],
    ["yaw", degrees(euler?.yaw)],
    ["standard deviation", angle(attitude?.sigma_rad)],
    ["error to the truth", angle(attitude?.error_rad)],
    ["spread of the lanes", angle(attitude?.spread_rad)],
    ["mode", attitude?.mode ?? "–"],
    ["frame", attitude?.sequence ?? "–"],
  ];
  const list = page("attitude-figures");
  if (list.children.length !== 2 * rows.length)
    list.replaceChildren(...rows.flatMap(([name]) => [Object.assign(document.createElement("dt"), { textContent: name }), document.createElement("dd")]));
  rows.forEach(([, value], row) => setText(list.children[2 * row + 1], String(value)));
}

/// Writes only what changed: the browser lays out nothing for the rest.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
