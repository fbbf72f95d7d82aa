// node rewrite_record.mjs FROM TO unchunked|none|lz4|brotli: writes a file's messages again by @mcap/core, as another tool would.
// `brotli` is a name that no reader knows; its chunks are not really compressed.
import {McapWriter} from '@mcap/core';
import lz4 from 'lz4js';
import fs from 'node:fs';
import {readForward} from './mcap.mjs';

const [, , from, to, kind] = process.argv;
const out = fs.openSync(to, 'w');
let position = 0;
const writable = {
  position: () => BigInt(position),
  write: async (bytes) => {
    position += fs.writeSync(out, bytes);
  },
};
const compressions = {
  none: undefined,
  unchunked: undefined,
  lz4: (bytes) => ({compression: 'lz4', compressedData: lz4.compress(bytes)}),
  brotli: (bytes) => ({compression: 'brotli', compressedData: bytes}),
};
const writer = new McapWriter({writable, useChunks: kind !== 'unchunked', compressChunk: compressions[kind], chunkSize: 100000});
await writer.start({profile: '', library: 'another tool'});
const schemas = new Map();
const channels = new Map();
for (const record of readForward(from).records) {
  if (record.type === 'Schema' && !schemas.has(record.id)) schemas.set(record.id, await writer.registerSchema(record));
  if (record.type === 'Channel' && !channels.has(record.id))
    channels.set(record.id, await writer.registerChannel({...record, schemaId: schemas.get(record.schemaId)}));
  if (record.type === 'Message') await writer.addMessage({...record, channelId: channels.get(record.channelId)});
}
await writer.end();
fs.closeSync(out);
