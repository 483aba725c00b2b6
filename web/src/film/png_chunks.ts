/** A chunk of a PNG file. */
export interface Chunk {
  type: string;
  data: Uint8Array;
}

const signature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

/** Returns the chunks of a PNG file. Throws Error if the bytes are not a PNG file. */
export function readChunks(file: Uint8Array): Chunk[] {
  if (signature.some((byte, i) => file[i] !== byte)) throw new Error("the browser wrote no PNG picture");
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const chunks: Chunk[] = [];
  for (let at = signature.length; at + 12 <= file.length;) {
    const length = view.getUint32(at);
    const type = String.fromCharCode(...file.subarray(at + 4, at + 8));
    chunks.push({ type, data: file.subarray(at + 8, at + 8 + length) });
    at += 12 + length;
  }
  return chunks;
}

/** Returns a PNG file of these chunks, each with its length and check sum. */
export function writeChunks(chunks: Chunk[]): Blob {
  const parts = chunks.map(({ type, data }) => {
    const bytes = new Uint8Array(12 + data.length);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, data.length);
    bytes.set([...type].map((letter) => letter.charCodeAt(0)), 4); // prettier-ignore
    bytes.set(data, 8);
    view.setUint32(8 + data.length, checkSum(bytes.subarray(4, 8 + data.length)));
    return bytes;
  });
  return new Blob([Uint8Array.from(signature), ...parts], { type: "image/png" });
}

/** Returns a chunk of numbers of 1, 2 or 4 bytes. */
export function numbersChunk(type: string, numbers: [value: number, bytes: 1 | 2 | 4][]): Chunk {
  const data = new Uint8Array(numbers.reduce((sum, [, bytes]) => sum + bytes, 0));
  const view = new DataView(data.buffer);
  let at = 0;
  for (const [value, bytes] of numbers) {
    if (bytes === 1) view.setUint8(at, value);
    else if (bytes === 2) view.setUint16(at, value);
    else view.setUint32(at, value);
    at += bytes;
  }
  return { type, data };
}

/** The CRC-32 of each byte. */
const table = Uint32Array.from({ length: 256 }, (_, byte) => {
  let sum = byte;
  for (let bit = 0; bit < 8; bit++) sum = sum & 1 ? 0xedb88320 ^ (sum >>> 1) : sum >>> 1;
  return sum;
});

/** Returns the CRC-32 of bytes (PNG specification, annex D). */
export function checkSum(bytes: Uint8Array): number {
  let sum = 0xffffffff;
  for (const byte of bytes) sum = table[(sum ^ byte) & 0xff] ^ (sum >>> 8);
  return ~sum >>> 0;
}
