// Orders to the system, where the monitor was started with --allow-orders. Each is confirmed before it is sent.

const page = (id) => document.getElementById(id);

async function send(order, what) {
  if (!confirm(`${what}?`)) return;
  const answer = await fetch("/order", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(order) });
  const result = await answer.json();
  page("order-answer").textContent = `${what}: ${result.error ?? result.status}`;
}

let started = false;

/// Shows the orders once they are allowed. @param selected  the axis whose tile is chosen.
export function allowOrders(allowed, selected) {
  page("orders").hidden = !allowed;
  if (!allowed || started) return;
  started = true;
  page("fault").value = `axis=${selected()},kind=bias,value=0.05,start=0`;
  page("inject").addEventListener("click", () => send({ action: "inject", fault: page("fault").value }, `Inject ${page("fault").value}`));
  page("clear").addEventListener("click", () => send({ action: "clear" }, "Clear all faults"));
  page("readmit").addEventListener("click", () => send({ action: "readmit", axes: [selected()] }, `Readmit axis ${selected()}`));
}
