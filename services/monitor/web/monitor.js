// The page: receives the stream, keeps what it shows, draws at most ten times a second.
import { showAttitude } from "./attitude.js";
import { showEvents, takeEvents } from "./events.js";
import { allowOrders } from "./orders.js";
import { drawPlots, startPlots } from "./plots.js";
import { Samples } from "./samples.js";
import { showLanes, showServices } from "./tables.js";
import { drawSparks, selected, showTiles } from "./tiles.js";

const page = (id) => document.getElementById(id);
const samples = new Samples();
const levelKinds = { FULL: "good", DEGRADED: "warn", SINGLE: "bad", COASTING: "bad", LOST: "bad", "NO OUTPUT": "bad" };
let state = null;
let paused = false;
let lastMessage = 0;

function show() {
  page("system").textContent = `${state.system} · unit ${state.unit}`;
  const level = page("level");
  level.hidden = !state.has_attitude;
  page("attitude-section").hidden = !state.has_attitude;
  if (level.textContent !== state.level) {
    level.textContent = state.level;
    level.className = `badge ${levelKinds[state.level] ?? "none"}`;
    document.title = `${state.level} · ${state.system}`;
  }
  showAttitude(state);
  showLanes(state);
  showServices(state);
  showTiles(state);
  allowOrders(state.orders, state.token, selected);
}

function draw() {
  page("link").textContent = paused ? "paused; still recording" : performance.now() - lastMessage < 2000 ? "live" : "no connection; trying again";
  if (paused || !state) return;
  drawSparks(samples);
  drawPlots(samples, state, selected());
}

function connect() {
  const stream = new EventSource("/stream");
  stream.addEventListener("state", (message) => {
    lastMessage = performance.now();
    const received = JSON.parse(message.data);
    samples.add(received.sample);
    if (paused) return;
    state = received;
    show();
  });
  for (const kind of ["events", "all_events"])
    stream.addEventListener(kind, (message) => {
      takeEvents(JSON.parse(message.data), kind === "all_events");
      if (!paused) showEvents();
    });
  // The browser connects again by itself after a lost connection, but not after a refusal.
  stream.addEventListener("error", () => {
    if (stream.readyState === EventSource.CLOSED) setTimeout(connect, 2000);
  });
}

function setPaused(now) {
  paused = now;
  page("pause").setAttribute("aria-pressed", String(paused));
  page("pause").textContent = paused ? "Resume" : "Pause";
  if (!paused) showEvents();
  draw();
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  drawPlots(samples, state, selected(), true);
}

function start() {
  setTheme(localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  page("pause").addEventListener("click", () => setPaused(!paused));
  page("theme").addEventListener("click", () => {
    const other = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    localStorage.setItem("theme", other);
    setTheme(other);
  });
  document.addEventListener("keydown", (key) => {
    if (/INPUT|SELECT/.test(key.target.tagName) || key.ctrlKey || key.metaKey || key.altKey) return;
    if (key.key === "p") page("pause").click();
    if (key.key === "d") page("theme").click();
  });
  startPlots(() => !paused && setPaused(true));
  connect();
  fetch("/history").then((answer) => answer.json()).then((past) => samples.addPast(past)).catch(() => {});
  setInterval(draw, 500);
}

start();
