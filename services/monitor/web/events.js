// The time line: newest first, by severity, source and text.

const page = (id) => document.getElementById(id);
const most = 500;
const severities = { INFO: 0, WARNING_LO: 1, WARNING_HI: 2, FATAL: 3 };
const kinds = ["none", "warn", "bad", "bad"];
let events = [];

const key = (event) => `${event.source}/${event.number}/${event.wall_time_ms}`;

export function takeEvents(received, all) {
  const known = new Set(all ? [] : events.map(key));
  events = [...(all ? [] : events), ...received.filter((event) => !known.has(key(event)))];
  events.sort((a, b) => a.wall_time_ms - b.wall_time_ms);
  events = events.slice(-most);
}

function clock(milliseconds) {
  const time = new Date(milliseconds);
  return `${time.toLocaleTimeString("en-GB")}.${String(time.getMilliseconds()).padStart(3, "0")}`;
}

function line(event) {
  const item = document.createElement("li");
  const severity = severities[event.severity] ?? 3;
  item.dataset.code = event.code;
  for (const [text, kind] of [[clock(event.wall_time_ms), ""], [event.source, ""], [event.code.toLowerCase().replaceAll("_", " "), kinds[severity]], [event.text, ""]]) {
    const part = item.appendChild(document.createElement("span"));
    part.textContent = text;
    part.className = kind;
  }
  return item;
}

function offerSources() {
  const select = page("source");
  const names = [...new Set(events.map((event) => event.source))].sort();
  if (select.dataset.names === names.join()) return;
  select.dataset.names = names.join();
  const chosen = select.value;
  select.replaceChildren(new Option("all", ""), ...names.map((name) => new Option(name, name)));
  select.value = names.includes(chosen) ? chosen : "";
}

export function showEvents() {
  offerSources();
  const least = Number(page("severity").value);
  const source = page("source").value;
  const text = page("text").value.toLowerCase();
  const shown = events.filter(
    (event) => (severities[event.severity] ?? 3) >= least && (!source || event.source === source) && `${event.code} ${event.text}`.toLowerCase().includes(text),
  );
  page("events").replaceChildren(...shown.reverse().map(line));
  page("event-count").textContent = `${shown.length} of ${events.length}`;
}

for (const id of ["severity", "source", "text"]) page(id).addEventListener("input", showEvents);
