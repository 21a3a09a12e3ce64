// Usage: node read_mcap.js FILE.mcap: reads it by its index with @mcap/core, and decodes every message by its own schema.
// The file is what `voxlist export --mcap` made of the scene.
import { McapIndexedReader } from "@mcap/core";
import { decompress } from "fzstd";
import { readFileSync } from "node:fs";
import { check, decoder, points_in, topics } from "./decode.js";

const seconds = 20, raw_channels = 15;
const file = readFileSync(process.argv[2]);
const reader = await McapIndexedReader.Initialize({
  readable: { size: async () => BigInt(file.length), read: async (at, size) => file.subarray(Number(at), Number(at + size)) },
  decompressHandlers: { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) },
});

const channels = [...reader.channelsById.values()];
const converted = channels.filter((channel) => channel.messageEncoding === "protobuf");
const raw = channels.filter((channel) => channel.messageEncoding === "x-lcm");
check("every topic is there", JSON.stringify(converted.map((c) => c.topic).sort()) === JSON.stringify(topics));
check("every channel of the log is there as it was", raw.length === raw_channels, raw.map((c) => c.topic));
const text = new TextDecoder();
for (const channel of raw) {
  const schema = reader.schemasById.get(channel.schemaId);
  const short_name = schema.name.replace("voxlist.", "");
  check(`${channel.topic} comes with its type`, text.decode(schema.data).includes(`struct ${short_name} {`));
}

const decoders = new Map(converted.map((channel) => {
  const schema = reader.schemasById.get(channel.schemaId);
  return [channel.id, decoder(schema.name, schema.data)];
}));
const last = new Map();
let messages = 0, time = 0n;
for await (const message of reader.readMessages()) {
  ++messages;
  if (message.logTime < time) throw new Error("FAILED: the index has its messages in the order of their times");
  time = message.logTime;
  const topic = reader.channelsById.get(message.channelId).topic;
  const decode = decoders.get(message.channelId);
  if (decode) last.set(topic, decode(message.data));
}
check("the index has every message", messages === Number(reader.statistics.messageCount), messages);
check("every topic is decoded", last.size === topics.length);
check("the map is as long as the drive", points_in(last.get("/map")) > 2500, points_in(last.get("/map")));
check("the path has every pose", points_in(last.get("/path")) === seconds);
check("a pose is where the robot was", last.get("/pose").pose.position.x === 0.5 * (seconds - 1));
check("a grid has its cells", last.get("/grid/low").data.length === 24);

let late = 0;
for await (const message of reader.readMessages({ startTime: time - 1_000_000_000n, topics: ["CLOUD"] })) late += message.data.length > 0;
check("any time is found by the index", late === 2, late);
