// Reads MCAP files by @mcap/core, whole or cut.
import {McapIndexedReader, McapStreamReader} from '@mcap/core';
import * as fzstd from 'fzstd';
import lz4 from 'lz4js';
import fs from 'node:fs';

export const decompressHandlers = {
  zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))),
  lz4: (bytes) => lz4.decompress(bytes),
};

/** Every record from the beginning on, as far as the file goes; checksums are validated. `ended` says whether it ends in order. */
export function readForward(name) {
  const reader = new McapStreamReader({validateCrcs: true, decompressHandlers});
  reader.append(fs.readFileSync(name));
  const records = [];
  for (let record; (record = reader.nextRecord()) !== undefined;) records.push(record);
  return {records, ended: reader.done()};
}

/** Messages by topic, as the index in the summary leads to them. */
export async function countByIndex(name) {
  const bytes = fs.readFileSync(name);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
  };
  const reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
  const counts = {};
  for await (const message of reader.readMessages()) {
    const {topic} = reader.channelsById.get(message.channelId);
    counts[topic] = (counts[topic] ?? 0) + 1;
  }
  return {counts, statistics: reader.statistics};
}
