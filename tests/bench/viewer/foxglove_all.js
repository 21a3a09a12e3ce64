// Usage: node foxglove_all.js PORT SECONDS: Foxglove's own client subscribes to every channel of a viewer, and tells what came.
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const [port, seconds] = process.argv.slice(2);
const client = new protocol.FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${port}`, ["foxglove.sdk.v1"]) });
const topics = new Map(), got = new Map();
client.on("advertise", (offered) => {
  for (const channel of offered) topics.set(client.subscribe(channel.id), channel.topic);
});
client.on("message", ({ subscriptionId, data }) => {
  const topic = topics.get(subscriptionId);
  const [messages, bytes] = got.get(topic) ?? [0, 0];
  got.set(topic, [messages + 1, bytes + data.byteLength]);
});
setTimeout(() => {
  for (const [topic, [messages, bytes]] of [...got].sort((a, b) => b[1][1] - a[1][1]))
    console.log(`${topic}: ${messages} messages, ${(bytes / 1000).toFixed(0)} kB`);
  process.exit(0);
}, 1000 * Number(seconds));
