// Usage: node foxglove_client.js PORT SUBPROTOCOL: Foxglove's own client subscribes to every channel of a viewer and decodes
// what comes, until each topic of the scene has come.
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";
import { check, decoder, points_in, topics } from "./decode.js";

const { FoxgloveClient } = protocol;
const [port, subprotocol] = process.argv.slice(2);
const wanted = topics.filter((topic) => topic !== "/truth"); // no service says that
const slower = Number(process.env.SLOWER ?? 1);
const socket = new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]);
const client = new FoxgloveClient({ ws: socket });
const channels = new Map();
const last = new Map();
let info, time;

function fail(why) {
  console.error(`FAILED: ${why}; ${subprotocol}: missing ${wanted.filter((topic) => !last.has(topic))}`);
  process.exit(1);
}

client.on("error", (error) => fail(String(error)));
client.on("close", () => fail("the connection is closed"));
client.on("serverInfo", (said) => (info = said));
client.on("time", (said) => (time = said.timestamp));
client.on("advertise", (offered) => {
  for (const channel of offered) {
    if (channel.encoding !== "protobuf" || channel.schemaEncoding !== "protobuf") fail(`${channel.topic} is no protobuf`);
    const decode = decoder(channel.schemaName, Buffer.from(channel.schema, "base64"));
    channels.set(client.subscribe(channel.id), { topic: channel.topic, decode });
  }
});
client.on("message", ({ subscriptionId, data }) => {
  const channel = channels.get(subscriptionId);
  last.set(channel.topic, channel.decode(new Uint8Array(data.buffer, data.byteOffset, data.byteLength)));
  if (time !== undefined && wanted.every((topic) => last.has(topic)) && is_whole()) finish();
});
setTimeout(() => fail(`it took too long, whole: ${is_whole()}`), 60_000 * slower);

// Who comes while the viewer still gets its map is told a part of it first.
function is_whole() {
  const points = (topic) => (last.has(topic) ? points_in(last.get(topic)) : 0);
  return points("/map") > 1000 && points("/free_space") > 10_000;
}

function finish() {
  check("the server speaks the protocol that was asked for", socket.protocol === subprotocol);
  check("it says who it is", info.name === "voxlist" && info.sessionId.length >= 16 && info.capabilities.includes("time"));
  check(`every channel came and was decoded as ${subprotocol}`, true);
  check("a cloud has points", points_in(last.get("/cloud")) > 0);
  check("a grid has its cells", last.get("/grid/low").data.length === 24);
  check("the map has the building's voxels, free space free and occupied cells", is_whole());
  check("what moves is a post with an arrow", last.get("/moving_obstacles").entities[0].arrows.length === 1);
  check("a scan has its beams", last.get("/scan/low").ranges.length === 5);
  check("the time is now", Math.abs(Number(time / 1_000_000n) - Date.now()) < 60_000 * slower);
  client.off("close");
  process.exit(0);
}
