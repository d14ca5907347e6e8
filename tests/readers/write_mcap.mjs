// Writes a file by @mcap/core with chunks, their checksums and a summary: sensor_msgs/msg/Imu in CDR
// on /imu, little-endian, and JSON on /battery: write_mcap.mjs FILE ROWS
import { open } from "node:fs/promises";

import { McapWriter } from "@mcap/core";

const [path, rows] = [process.argv[2], Number(process.argv[3])];
const start = 1700000000_000000000n;
const step = 10_000_000n;

const rule = "=".repeat(80);
const imuDefinition = `std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
${rule}
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
${rule}
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
${rule}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
${rule}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;

function imu(stamp, k) {
  const bytes = new Uint8Array(4 + 24 + 8 * (4 + 9 + 3 + 9 + 3 + 9));
  const view = new DataView(bytes.buffer, 4);
  bytes[1] = 1;
  view.setInt32(0, Number(stamp / 1_000_000_000n), true);
  view.setUint32(4, Number(stamp % 1_000_000_000n), true);
  view.setUint32(8, 9, true);
  bytes.set(new TextEncoder().encode("imu_link\0"), 4 + 12);
  const figures = [0, 0, 0, 1, ...Array(9).fill(0), 0.01, 0.02, 0.03, ...Array(9).fill(0),
    0.001 * k, -0.5, 9.81, ...Array(9).fill(0)];
  figures.forEach((figure, i) => view.setFloat64(24 + 8 * i, figure, true));
  return bytes;
}

const file = await open(path, "w");
let position = 0n;
const writer = new McapWriter({
  chunkSize: 4096,
  writable: {
    write: async (buffer) => {
      await file.write(buffer);
      position += BigInt(buffer.byteLength);
    },
    position: () => position,
  },
});
const text = (value) => new TextEncoder().encode(value);
await writer.start({ profile: "ros2", library: "write_mcap.mjs" });
const imuSchema = await writer.registerSchema(
  { name: "sensor_msgs/msg/Imu", encoding: "ros2msg", data: text(imuDefinition) });
const jsonSchema = await writer.registerSchema(
  { name: "battery", encoding: "jsonschema", data: text('{"type":"object"}') });
const imuChannel = await writer.registerChannel(
  { schemaId: imuSchema, topic: "/imu", messageEncoding: "cdr", metadata: new Map() });
const jsonChannel = await writer.registerChannel(
  { schemaId: jsonSchema, topic: "/battery", messageEncoding: "json", metadata: new Map() });
for (let k = 0; k < rows; ++k) {
  const stamp = start + BigInt(k) * step;
  const logTime = stamp + 3_000_000n;
  await writer.addMessage(
    { channelId: imuChannel, sequence: k, logTime, publishTime: logTime, data: imu(stamp, k) });
  if (k % 10 === 0)
    await writer.addMessage({
      channelId: jsonChannel, sequence: k, logTime, publishTime: logTime,
      data: text(JSON.stringify({ voltage: 12 - 0.001 * k, cell: { temp: 20 + k } })),
    });
}
await writer.addMetadata({ name: "bench", metadata: new Map([["rig", "7"]]) });
await writer.end();
await file.close();
