// Reads an MCAP file by @mcap/core, by its index and with every checksum compared, and says as JSON
// what is in it: read_mcap.mjs FILE
import { open } from "node:fs/promises";

import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const path = process.argv[2];

// Front to end without the index: the checksums of the data section and of attachments too.
async function streamed(file) {
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(await file.readFile());
  await file.close();
  const kinds = {};
  for (let record; (record = reader.nextRecord()); ) kinds[record.type] = (kinds[record.type] ?? 0) + 1;
  return { kinds, done: reader.done() };
}

// A block of samples as docs/formats.md lays it out.
function block(data) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const [version, flags, columns, rows] =
    [view.getUint8(0), view.getUint8(1), view.getUint16(2, true), view.getUint32(4, true)];
  const figures = [];
  for (let at = 16; at < data.byteLength; at += 8) figures.push(view.getFloat64(at, true));
  const take = () => figures.splice(0, rows);
  return {
    version, rows, first: Number(view.getBigUint64(8, true)),
    stamps: flags & 1 ? take() : [], columns: Array.from({ length: columns }, take),
  };
}

const file = await open(path);
const { size } = await file.stat();
const readable = {
  size: async () => BigInt(size),
  read: async (offset, length) => {
    const buffer = new Uint8Array(Number(length));
    await file.read(buffer, 0, Number(length), Number(offset));
    return buffer;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
const blocks = [];
const times = [];
for await (const message of reader.readMessages({ validateCrcs: true })) {
  blocks.push(block(message.data));
  times.push(String(message.logTime));
}
const metadata = {};
for await (const record of reader.readMetadata()) metadata[record.name] = Object.fromEntries(record.metadata);
const attachments = {};
for await (const record of reader.readAttachments({ validateCrcs: true }))
  attachments[record.name] = new TextDecoder().decode(record.data);
const [channel] = reader.channelsById.values();
const schema = reader.schemasById.get(channel.schemaId);
await file.close();
console.log(JSON.stringify({
  library: reader.header.library,
  encoding: channel.messageEncoding,
  channel: Object.fromEntries(channel.metadata),
  schema: JSON.parse(new TextDecoder().decode(schema.data)),
  schemaEncoding: schema.encoding,
  messageCount: Number(reader.statistics.messageCount),
  chunks: reader.chunkIndexes.length,
  blocks, times, metadata, attachments,
  streamed: await streamed(await open(path)),
}, (_, value) => (typeof value === "bigint" ? String(value) : value)));
