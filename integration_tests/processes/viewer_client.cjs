// Connects as Foxglove does, by the protocol's own client package, and prints what it received as one JSON object.
// usage: node viewer_client.cjs URL SUBPROTOCOL MESSAGES      (of the first channel; the packages come by NODE_PATH)
"use strict";
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");

const [url, subprotocol, wanted] = process.argv.slice(2);
const found = { protocol: null, serverInfo: null, channels: [], messages: {}, status: [], afterUnsubscribe: 0 };
const socket = new WebSocket(url, [subprotocol]);
const client = new FoxgloveClient({ ws: socket });
const topics = new Map(); // by subscription
let counted;
let ended = false;

client.on("error", (error) => {
  console.error(String(error));
  process.exit(1);
});
client.on("open", () => { found.protocol = socket.protocol; });
client.on("serverInfo", (info) => { found.serverInfo = info; });
client.on("status", (status) => found.status.push(status));
client.on("advertise", (channels) => {
  found.channels = channels;
  for (const channel of channels) {
    const subscription = client.subscribe(channel.id);
    topics.set(subscription, channel.topic);
    found.messages[channel.topic] = [];
    counted ??= subscription;
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  if (ended) {
    found.afterUnsubscribe += subscriptionId === counted ? 1 : 0;
    return;
  }
  const list = found.messages[topics.get(subscriptionId)];
  list.push({ timestamp: String(timestamp), message: JSON.parse(new TextDecoder().decode(data)) });
  if (subscriptionId !== counted || list.length < Number(wanted)) return;
  client.unsubscribe(counted);
  setTimeout(() => { // what was under way arrives
    ended = true;
    setTimeout(() => {
      console.log(JSON.stringify(found));
      client.close();
    }, 500);
  }, 300);
});
