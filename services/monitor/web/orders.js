// Orders to the system, where the monitor was started with --allow-orders. Each is confirmed before it is sent.

const page = (id) => document.getElementById(id);

/// A page from this host itself needs no token; the server judges the same by the connection.
const local = /^(localhost|127\.)/.test(location.hostname);

/// @returns whether the user confirms. The token stays in its field for the next order, and nowhere else.
function confirmed(what) {
  const dialog = page("confirmation");
  page("order-question").textContent = `${what}?`;
  page("token-part").hidden = local;
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => dialog.addEventListener("close", () => resolve(dialog.returnValue === "send"), { once: true }));
}

async function send(order, what) {
  if (!(await confirmed(what))) return;
  const headers = { "Content-Type": "application/json" };
  if (!local) headers.Authorization = `Bearer ${page("token").value.trim()}`;
  const answer = await fetch("/order", { method: "POST", headers, body: JSON.stringify(order) });
  const result = await answer.json();
  if (answer.status === 403) page("token").value = "";
  page("order-answer").textContent = `${what}: ${result.error ?? result.status}`;
}

let started = false;

/// Shows the orders once they are allowed. @param token  whether the monitor has one: other hosts may send orders too.
/// @param selected  the axis whose tile is chosen.
export function allowOrders(allowed, token, selected) {
  page("orders").hidden = !allowed || !(local || token);
  if (page("orders").hidden || started) return;
  started = true;
  page("fault").value = `axis=${selected()},kind=bias,value=0.05,start=0`;
  page("inject").addEventListener("click", () => send({ action: "inject", fault: page("fault").value }, `Inject ${page("fault").value}`));
  page("clear").addEventListener("click", () => send({ action: "clear" }, "Clear all faults"));
  page("readmit").addEventListener("click", () => send({ action: "readmit", axes: [selected()] }, `Readmit axis ${selected()}`));
  page("order-send").addEventListener("click", () => page("confirmation").close("send"));
  page("order-cancel").addEventListener("click", () => page("confirmation").close(""));
  page("token").addEventListener("keydown", (key) => key.key === "Enter" && page("order-send").click());
}
