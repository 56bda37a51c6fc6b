// The answer, a stream of records on standard output: tag, length, then as many bytes. ifc_answer.h tells what is in them.

import fs from 'node:fs';

export const kTag = { progress: 1, mesh: 2, space: 3, end: 4 };

function writeAll(bytes) {
  for (let sent = 0; sent < bytes.length;) {
    try {
      sent += fs.writeSync(1, bytes, sent);
    } catch (error) {
      if (error.code !== 'EAGAIN') throw error;
    }
  }
}

export function writeStart() {
  writeAll(Buffer.from('CLIFC001', 'latin1'));
}

export function writeRecord(tag, ...parts) {
  const head = Buffer.alloc(16);
  head.writeUInt32LE(tag, 0);
  head.writeBigUInt64LE(BigInt(parts.reduce((n, part) => n + part.length, 0)), 8);
  writeAll(head);
  for (const part of parts) writeAll(part);
}

export const utf8 = (text) => Buffer.from(text, 'utf8');
const bytesOf = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);

/** A mesh of float vertices in a frame of its own, and its place: 3 rows of 4, to metres, z up. */
export function writeMesh(tag, owner, material, place, vertices, corners) {
  writeRecord(
    tag,
    bytesOf(Uint32Array.of(owner, material, vertices.length / 3, corners.length)),
    bytesOf(Float64Array.from(place)),
    bytesOf(vertices),
    bytesOf(corners),
  );
}
