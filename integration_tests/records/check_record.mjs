// node check_record.mjs FILE FRAMES.csv: decodes every message by Foxglove's libraries, encodes it again, and prints what it found as JSON.
// The frames go to FRAMES.csv: sample time [ns] and increments.
import {parseIDL} from '@foxglove/omgidl-parser';
import {MessageReader as IdlReader, MessageWriter as IdlWriter} from '@foxglove/omgidl-serialization';
import {parse as parseRosMessage} from '@foxglove/rosmsg';
import {MessageReader as RosReader, MessageWriter as RosWriter} from '@foxglove/rosmsg2-serialization';
import publishedSchemas from '@foxglove/schemas/jsonschema.js';
import {createHash} from 'node:crypto';
import fs from 'node:fs';
import {isDeepStrictEqual} from 'node:util';
import {countByIndex, readForward} from './mcap.mjs';

/** A JSON schema without what is only for people. */
function bare(schema) {
  if (Array.isArray(schema)) return schema.map(bare);
  if (schema === null || typeof schema !== 'object') return schema;
  return Object.fromEntries(Object.entries(schema).filter(([key]) => key !== 'description' && key !== '$comment').map(([key, value]) => [key, bare(value)]));
}

function flat(message) {
  const rows = (value) => (Array.isArray(value) && value.some((row) => typeof row === 'object') ? value.flatMap((row) => [...row]) : value);
  return Object.fromEntries(Object.entries(message).map(([key, value]) => [key, rows(value)]));
}

function codecOf(channel, schema) {
  const text = new TextDecoder().decode(schema.data);
  const kind = `${schema.encoding}/${channel.messageEncoding}`;
  if (kind === 'omgidl/cdr') {
    // The writer knows no arrays of arrays: it gets them as one row, which is the same on the wire.
    const flatText = text.replace(/\[(\d+)\]\[(\d+)\]/g, (_, rows, columns) => `[${rows * columns}]`);
    const reader = new IdlReader(schema.name, parseIDL(text));
    const writer = new IdlWriter(schema.name, parseIDL(flatText));
    return {decode: (bytes) => reader.readMessage(bytes), encode: (message) => writer.writeMessage(flat(message))};
  }
  if (kind === 'ros2msg/cdr') {
    const types = parseRosMessage(text, {ros2: true});
    const [reader, writer] = [new RosReader(types), new RosWriter(types)];
    return {decode: (bytes) => reader.readMessage(bytes), encode: (message) => writer.writeMessage(message)};
  }
  if (kind === 'jsonschema/json') {
    if (schema.name !== 'foxglove.FrameTransform' || !isDeepStrictEqual(bare(JSON.parse(text)), bare(publishedSchemas.FrameTransform)))
      throw new Error(`${schema.name}: not the schema that Foxglove publishes`);
    return {decode: (bytes) => JSON.parse(new TextDecoder().decode(bytes)), encode: null};
  }
  throw new Error(`${channel.topic}: unexpected encoding ${kind}`);
}

const [, , file, framesFile] = process.argv;
const {records, ended} = readForward(file);
const schemas = new Map();
const channels = new Map();
const topics = {};
const frames = [];
const voted = [];
const transforms = [];
const imus = [];
let lastLogTime = 0n;
const compressions = new Set();
for (const record of records) {
  if (record.type === 'Schema') schemas.set(record.id, record);
  if (record.type === 'ChunkIndex') compressions.add(record.compression);
  if (record.type === 'Channel' && !channels.has(record.id)) {
    const schema = schemas.get(record.schemaId);
    channels.set(record.id, {topic: record.topic, codec: codecOf(record, schema), hash: createHash('sha256'), last: -1});
    topics[record.topic] = {schema: schema.name, messages: 0, bytes: 0, differ: 0, outOfSequence: 0};
  }
  if (record.type !== 'Message') continue;
  const channel = channels.get(record.channelId);
  const topic = topics[channel.topic];
  const message = channel.codec.decode(record.data);
  ++topic.messages;
  topic.bytes += record.data.length;
  lastLogTime = record.logTime;
  channel.hash.update(record.data);
  if (record.sequence !== channel.last + 1) ++topic.outOfSequence;
  channel.last = record.sequence;
  if (channel.codec.encode && Buffer.compare(Buffer.from(channel.codec.encode(message)), Buffer.from(record.data)) !== 0) ++topic.differ;
  if (topic.schema === 'quorient_msgs::SensorFrame') frames.push([message.sample_time_ns, ...message.increment.slice(0, message.axis_count)].join(','));
  if (topic.schema === 'quorient_msgs::VotedAttitude') voted.push(message);
  if (topic.schema === 'foxglove.FrameTransform') transforms.push(message);
  if (topic.schema === 'sensor_msgs/msg/Imu') imus.push(message);
}
for (const channel of channels.values()) topics[channel.topic].sha256 = channel.hash.digest('hex');
fs.writeFileSync(framesFile, frames.map((row) => `${row}\n`).join(''));

const indexed = ended ? await countByIndex(file) : null;
const text = (key, value) => (typeof value === 'bigint' ? Number(value) : value instanceof Map ? Object.fromEntries(value) : ArrayBuffer.isView(value) ? [...value] : value);
console.log(JSON.stringify({
  ended, topics, compressions: [...compressions], indexed: indexed?.counts ?? null, statistics: indexed?.statistics ?? null,
  lastLogTime, lastVoted: voted.at(-1) ?? null, lastTransform: transforms.at(-1) ?? null, lastImu: imus.at(-1) ?? null,
}, text));
