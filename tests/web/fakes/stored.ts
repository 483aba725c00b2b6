/** Returns the bytes as a Zstandard frame of one block that is not compressed (RFC 8878). */
export function stored(bytes: Uint8Array): Uint8Array {
  const size = [...new Uint8Array(new BigUint64Array([BigInt(bytes.length)]).buffer)];
  const block = 1 + (bytes.length << 3);
  return Uint8Array.from([0x28, 0xb5, 0x2f, 0xfd, 0xe0, ...size, block, block >> 8, block >> 16, ...bytes]);
}
