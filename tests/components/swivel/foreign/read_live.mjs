// What a client of others hears: connects to ADDRESS by the Foxglove WebSocket protocol, subscribes
// to each TOPIC, decodes the first message of each by the definition that was advertised, and prints
// them as JSON.
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";
import { decoderOf } from "./decoders.mjs";

const { FoxgloveClient } = protocol;
const [address, ...topics] = process.argv.slice(2);
const client = new FoxgloveClient({
  ws: new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});
const subscribed = new Map();
const heard = {};

const plain = (_, value) => {
  if (typeof value === "bigint") return Number(value);
  return ArrayBuffer.isView(value) ? Array.from(value).slice(0, 16) : value;
};

client.on("error", (error) => {
  console.error(error);
  process.exit(1);
});
client.on("advertise", (channels) => {
  for (const channel of channels) {
    if (!topics.includes(channel.topic)) continue;
    subscribed.set(client.subscribe(channel.id), channel);
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const channel = subscribed.get(subscriptionId);
  const decoder = decoderOf(channel.schemaEncoding, channel.schemaName, channel.schema);
  heard[channel.topic] = { timestamp, message: decoder.readMessage(data) };
  if (Object.keys(heard).length < topics.length) return;
  console.log(JSON.stringify(heard, plain));
  process.exit(0);
});
