/** Bytes of a tar archive's header, and of the blocks that its files fill. */
const block = 512;

/**
 * Packs files as one tar archive (POSIX ustar), without copying their content. Names have at most 100 ASCII letters.
 */
export function packTar(files: { name: string; content: Blob }[]): File {
  const parts = files.flatMap(({ name, content }) => [
    header(name, content.size),
    content,
    new Uint8Array((block - (content.size % block)) % block),
  ]);
  return new File([...parts, new Uint8Array(2 * block)], "labels.tar");
}

function header(name: string, size: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(block);
  const put = (at: number, text: string) => bytes.set(new TextEncoder().encode(text), at);
  const octal = (value: number, digits: number) => value.toString(8).padStart(digits, "0");
  put(0, name.slice(0, 100));
  put(100, ["0000644", "0000000", "0000000", ""].join("\0"));
  put(124, `${octal(size, 11)}\0${octal(0, 11)}\0`);
  put(148, " ".repeat(8)); // counted as spaces in the sum
  put(156, "0");
  put(257, `ustar\0${octal(0, 2)}`);
  const sum = bytes.reduce((all, byte) => all + byte, 0);
  put(148, `${octal(sum, 6)}\0 `);
  return bytes;
}
