import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, test } from "vitest";
import { neutralNames, structureWords } from "../../../web/src/patient/file_words";
import { packTar } from "../../../web/src/patient/tar";

test("WordsOfAStructureStayAndThoseOfAPersonDoNot", () => {
  expect(structureWords("DOE^JANE 1948_rib_left_7.nii.gz")).toBe("rib left 7");
  expect(structureWords("moose_19480312_CT_Ribs_0000.nii.gz")).toBe("ribs");
  expect(structureWords("doe-jane_part_551.nii.gz")).toBe("551");
  expect(structureWords("vertebrae_T12.nii.gz")).toBe("vertebrae t12");
  expect(structureWords("Rib7_L.nii")).toBe("rib 7 l");
  expect(structureWords("Heart-Jane-12-3.nii")).toBe("heart");
  expect(structureWords("IM000001")).toBe("");
});

test("NamesOfOnePatientsFilesDiffer", () => {
  const names = neutralNames(["a/labels.nii.gz", "b/labels.nii.gz", "liver.nii.gz"]);
  expect(names).toEqual(["faa", "fab", "fac liver"]);
  expect(new Set(neutralNames(Array.from({ length: 300 }, () => "x"))).size).toBe(300);
});

test("AnotherProgramUnpacksWhatWasPacked", async () => {
  const folder = mkdtempSync(join(tmpdir(), "tar-"));
  const contents = [new Uint8Array(0), new Uint8Array(512).fill(7), new Uint8Array(1300).map((_, i) => i)];
  const packed = packTar(
    contents.map((content, i) => ({ name: `fa${i} rib left ${i}`, content: new Blob([content]) })),
  );
  writeFileSync(join(folder, "a.tar"), new Uint8Array(await packed.arrayBuffer()));
  execFileSync("tar", ["-xf", "a.tar"], { cwd: folder });
  for (const [i, content] of contents.entries())
    expect(new Uint8Array(readFileSync(join(folder, `fa${i} rib left ${i}`)))).toEqual(content);
  rmSync(folder, { recursive: true });
});
