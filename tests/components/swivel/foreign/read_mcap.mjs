// What programs of others make of our MCAP files: reads FILE with npm's @mcap/core, decodes every
// message by the definition that stands in the file, and prints counts and sums as JSON.
import { McapIndexedReader } from "@mcap/core";
import { open } from "node:fs/promises";
import { decoderOf } from "./decoders.mjs";

const sum = (numbers) => numbers.reduce((total, number) => total + Number(number), 0);

// The values that a topic's messages are compared by, and how they are added up.
const values = {
  scan_line: (line) => ({
    numbers: Number(line.sequence_number),
    beam0_ms: Number(line.beam0_time_ns % 1000000000n / 1000000n),
    ranges: sum(line.ranges_mm),
    intensities: sum(line.intensities),
    beam_step_deg: line.beam_step_deg,
  }),
  axis: (axis) => ({ samples: axis.samples.length, angle_deg: sum(axis.samples.map((s) => s.angle_deg)) }),
  sweep: (sweep) => ({ ids: Number(sweep.sweep_id), phases: sweep.phase, letters: sweep.reason.length }),
  attitude: (attitude) => ({ beta_deg: attitude.beta_deg, verdicts: attitude.verdict }),
  raw_cloud: (cloud) => ({ bytes: cloud.data.length, sum: sum(cloud.data), seconds: cloud.header.stamp.sec }),
};
values.cloud = values.raw_cloud;

const file = await open(process.argv[2]);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await file.read(bytes, 0, bytes.length, Number(offset));
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
const decoders = new Map();
for (const [id, schema] of reader.schemasById) {
  decoders.set(id, decoderOf(schema.encoding, schema.name, new TextDecoder().decode(schema.data)));
}

const topics = {};
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  const decoded = decoders.get(channel.schemaId).readMessage(message.data);
  const topic = (topics[channel.topic] ??= { messages: 0 });
  topic.messages += 1;
  const added = values[channel.topic.split("/").at(-1)]?.(decoded) ?? {};
  for (const [name, value] of Object.entries(added)) topic[name] = (topic[name] ?? 0) + value;
}
console.log(JSON.stringify({ statistics: Number(reader.statistics.messageCount), topics }));
