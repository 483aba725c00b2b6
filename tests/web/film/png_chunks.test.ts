import { expect, test } from "vitest";
import { checkSum, numbersChunk, readChunks, writeChunks } from "../../../web/src/film/png_chunks";

const bytesOf = async (file: Blob) => new Uint8Array(await file.arrayBuffer());

test("TheCheckSumIsThatOfTheSpecification", () => {
  // The chunk IEND is the same in every PNG file.
  expect(checkSum(new TextEncoder().encode("IEND"))).toBe(0xae426082);
  expect(checkSum(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
});

test("ChunksThatAreWrittenAreReadAgain", async () => {
  const chunks = [
    numbersChunk("fcTL", [[1, 4], [258, 2], [7, 1]]), // prettier-ignore
    { type: "IEND", data: new Uint8Array(0) },
  ];
  expect([...chunks[0].data]).toEqual([0, 0, 0, 1, 1, 2, 7]);
  expect(readChunks(await bytesOf(writeChunks(chunks)))).toEqual(chunks);
});

test("AFileThatIsNoPngIsRefused", () => {
  expect(() => readChunks(new TextEncoder().encode("GIF89a"))).toThrow("no PNG");
});
