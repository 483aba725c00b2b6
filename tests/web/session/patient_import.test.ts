import { create } from "@bufbuild/protobuf";
import { createRouterTransport } from "@connectrpc/connect";
import { expect, test } from "vitest";
import { createApi } from "../../../web/src/connection/api";
import { ReadinessVerdict } from "../../../web/src/gen/phrenic/v1/patient_pb";
import { LabelMeaningSchema } from "../../../web/src/gen/phrenic/v1/patient_pb";
import { PatientService, PatientState } from "../../../web/src/gen/phrenic/v1/patients_pb";
import { SessionService } from "../../../web/src/gen/phrenic/v1/session_pb";
import { UploadKind, UploadService } from "../../../web/src/gen/phrenic/v1/upload_pb";
import { droppedFiles, findVolumes } from "../../../web/src/patient/patient_files";
import { PatientImport } from "../../../web/src/patient/patient_import";

const dicom = (sopClass: string, name = "IM1") =>
  new File([new Uint8Array(128), "DICM\x02\x00\x02\x00UI\x1a\x00", sopClass, "\x00\x02\x00\x03\x00"], name);
const segmentation = dicom("1.2.840.10008.5.1.4.1.1.66.4");

/** A server that makes a patient with this verdict, and what it was asked. */
function fakeServer(verdict: ReadinessVerdict) {
  const asked: string[] = [];
  const report = { readiness: { verdict, findings: [{ verdict, what: "12 ribs are missing" }] } };
  const transport = createRouterTransport(({ service }) => {
    service(UploadService, {
      beginUpload: ({ name, kind }) => (asked.push(`${name} ${UploadKind[kind]}`), { uploadId: "u" }),
      addUploadChunk: ({ chunk, offset }) => ({ received: offset + BigInt(chunk.length) }),
      finishUpload: () => ({ file: { path: "upload:1" } }),
      deleteUpload: ({ path }) => (asked.push(`delete ${path}`), {}),
    });
    service(PatientService, {
      inspectLabels: ({ path, map }) => (asked.push(`inspect ${path} ${map}`.trim()), { labels: [{ number: 7 }] }),
      createPatient: ({ labels, anyway, map }) => (
        asked.push(`create ${labels.map(({ number, name }) => `${number} ${name}`)} ${anyway} ${map}`.trim()),
        { patient: { id: "p" } }
      ),
      watchPatient: async function* () {
        yield { patient: { id: "p", state: PatientState.RUNNING, progress: 0.5, doing: "rib-5-left" } };
        const done = verdict !== ReadinessVerdict.NOT_USABLE;
        yield {
          patient: {
            id: "p",
            report,
            ...(done ? { state: PatientState.DONE, scene: {} } : { state: PatientState.FAILED, problem: "not usable" }),
          },
        };
      },
      deletePatient: ({ patientId }) => (asked.push(`delete ${patientId}`), {}),
    });
    service(SessionService, {
      createSession: ({ source }) => (asked.push(`session of a ${source?.source.case}`), { session: { id: "s" } }),
      playSession: () => ({}),
    });
  });
  return { api: createApi(transport), asked };
}

const liver = create(LabelMeaningSchema, { number: 7, name: "liver" });

test("ADroppedVolumeBecomesASessionAndItsFileIsDeleted", async () => {
  const { api, asked } = fakeServer(ReadinessVerdict.READY);
  const opened: string[] = [];
  const importing = new PatientImport(api, (id) => opened.push(id));
  const kinds: string[] = [];
  importing.state.subscribe(({ kind }) => kinds.at(-1) !== kind && kinds.push(kind));
  await importing.take([segmentation]);
  await importing.make([liver], false);
  await importing.openSession();
  expect(opened).toEqual(["s"]);
  expect(kinds).toEqual(["empty", "sending", "reading", "naming", "making", "made", "opening", "empty"]);
  expect(asked).toEqual([
    "labels LABELS",
    "inspect upload:1",
    "create 7 liver false",
    "session of a scene",
    "delete p",
    "delete upload:1",
  ]);
});

test("ARefusalHasItsReportAndMayBeOverruled", async () => {
  const { api, asked } = fakeServer(ReadinessVerdict.NOT_USABLE);
  const importing = new PatientImport(api, () => expect.unreachable());
  await importing.take([segmentation]);
  await importing.make([], false);
  expect(importing.state.value).toMatchObject({ kind: "refused", report: { readiness: { findings: [{}] } } });
  await importing.make([], true);
  expect(asked.at(-1)).toBe("create  true");
});

test("OfManyFilesOnlyAChosenSegmentationIsSent", async () => {
  const { api, asked } = fakeServer(ReadinessVerdict.READY);
  const importing = new PatientImport(api, () => undefined);
  const slices = ["1", "2", "3"].map((name) => dicom("1.2.840.10008.5.1.4.1.1.2\x00", name));
  await importing.take([...slices, segmentation, dicom("1.2.840.10008.5.1.4.1.1.481.3"), new File(["x"], "notes.txt")]);
  expect(importing.state.value).toMatchObject({ kind: "choosing", found: { images: 3, others: 1 } });
  expect(asked).toEqual([]);
  await importing.take([...slices, segmentation]);
  expect(importing.state.value.kind).toBe("naming");
});

test("SeveralFilesOfOnePatientAreSentAsOneAndReadByAChosenProgram", async () => {
  const { api, asked } = fakeServer(ReadinessVerdict.READY);
  const importing = new PatientImport(api, () => undefined);
  const files = [
    dicom("1.2.840.10008.5.1.4.1.1.66.4", "DOE rib 7"),
    dicom("1.2.840.10008.5.1.4.1.1.66.4", "DOE heart"),
  ];
  await importing.take(files);
  expect(importing.state.value.kind).toBe("choosing");
  await importing.read(files);
  await importing.readBy("moose");
  await importing.make([liver], false);
  expect(asked).toEqual(["labels LABELS", "inspect upload:1", "inspect upload:1 moose", "create 7 liver false moose"]);
});

test("FilesAreKnownByTheirContent", async () => {
  const nifti = new Uint8Array(352);
  nifti.set([0x6e, 0x2b, 0x31, 0], 344);
  const gzip = new Uint8Array([0x1f, 0x8b, 8, 0]);
  const files = [new File([nifti], "labels"), new File([gzip], "a.nii.gz"), new File([gzip], "a.tar.gz")];
  const found = await findVolumes([...files, new File([], "empty"), dicom("1.2.840.10008.5.1.4.1.1.66.5")]);
  expect(found.volumes.map(({ name }) => name)).toEqual(["labels", "a.nii.gz"]);
  expect([found.images, found.others]).toEqual([1, 2]);
});

test("ArchivesThatAreNotReadAreNamed", async () => {
  const bytes = (...numbers: number[]) => new Uint8Array(numbers);
  const files = [
    new File([bytes(0x1f, 0x8b, 8, 0)], "a.tgz"),
    new File([bytes(0x37, 0x7a, 0xbc, 0xaf, 0x27, 0x1c)], "b.7z"),
    new File([bytes(0x52, 0x61, 0x72, 0x21, 0x1a, 0x07)], "c.rar"),
    new File([bytes(0xfd, 0x37, 0x7a, 0x58, 0x5a, 0)], "d.tar.xz"),
    new File([bytes(0x28, 0xb5, 0x2f, 0xfd)], "e.tar.zst"),
    new File(["BZh9"], "f.nii.bz2"),
    new File([bytes(0x1f, 0x8b, 8, 0)], "notes.txt.gz"),
  ];
  const found = await findVolumes(files);
  expect(found.unread.map(({ name }) => name)).toEqual(files.slice(0, 6).map(({ name }) => name));
  expect([found.volumes.length, found.others]).toEqual([0, 7]);
  // A segmentation beside one is not sent without a word.
  const { api, asked } = fakeServer(ReadinessVerdict.READY);
  const importing = new PatientImport(api, () => undefined);
  await importing.take([segmentation, files[1]]);
  expect(importing.state.value).toMatchObject({ kind: "choosing", found: { unread: [{ name: "b.7z" }] } });
  expect(asked).toEqual([]);
});

test("FoldersAreReadToTheirLastEntry", async () => {
  const entry = (name: string) => ({ isFile: true, file: (done: (file: File) => void) => done(new File([], name)) });
  const folder = (entries: object[]) => {
    const parts = [entries.slice(0, 1), entries.slice(1), []];
    return {
      isFile: false,
      isDirectory: true,
      createReader: () => ({ readEntries: (done: (some: object[]) => void) => done(parts.shift()!) }),
    };
  };
  const dropped = folder([entry("a"), folder([entry("b"), entry("c")]), entry("d")]);
  const files = await droppedFiles({ entries: [dropped as unknown as FileSystemEntry], files: [] });
  expect(files.map(({ name }) => name)).toEqual(["a", "b", "c", "d"]);
});
