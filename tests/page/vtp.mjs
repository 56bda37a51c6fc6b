// A result as `clerestory solve` writes it, read without VTK: XML with zlib streams in base 64.

import fs from 'node:fs';
import zlib from 'node:zlib';

const kTypes = { Float32: Float32Array, Float64: Float64Array, Int32: Int32Array, Int64: BigInt64Array, UInt32: Uint32Array, UInt8: Uint8Array, Int8: Int8Array };

function decode(text) {
  // Head: count of blocks, their size, size of the last, then how long each is as it is stored.
  const words = (base64) => new Uint32Array(new Uint8Array(Buffer.from(base64, 'base64')).buffer);
  const blocks = words(text.slice(0, 16))[0];
  const headLength = Math.ceil(((3 + blocks) * 4) / 3) * 4;
  const sizes = words(text.slice(0, headLength)).slice(3, 3 + blocks);
  const stored = Buffer.from(text.slice(headLength), 'base64');
  const parts = [];
  let at = 0;
  for (const size of sizes) {
    parts.push(zlib.inflateSync(stored.subarray(at, at + size)));
    at += size;
  }
  return Buffer.concat(parts);
}

export class Vtp {
  constructor(file) {
    this.xml = fs.readFileSync(file, 'latin1');
  }

  /** An array within a section of the file: ('PointData', 'illuminance'). */
  bytes(section, name) {
    const begin = section === 'FieldData' ? this.xml.indexOf('<FieldData') : this.xml.indexOf(`<${section}`);
    const part = this.xml.slice(begin, this.xml.indexOf(`</${section}>`, begin));
    const found = [...part.matchAll(/<(?:Data)?Array ([^>]*)>\s*([A-Za-z0-9+/=]*)/g)].find((m) => m[1].includes(`Name="${name}"`));
    if (!found) throw new Error(`the result has no ${name} in ${section}`);
    return { type: /type="(\w+)"/.exec(found[1])[1], bytes: decode(found[2]) };
  }

  numbers(section, name) {
    const { type, bytes } = this.bytes(section, name);
    return Array.from(new kTypes[type](new Uint8Array(bytes).buffer), Number);
  }

  /** Strings follow one another, each ended by a 0. */
  strings(name) {
    return this.bytes('FieldData', name).bytes.toString('utf8').split('\0').slice(0, -1);
  }
}
