import { create } from "@bufbuild/protobuf";
import { Code, ConnectError, createRouterTransport } from "@connectrpc/connect";
import { beforeEach, expect, test, vi } from "vitest";
import { createApi } from "../../../web/src/connection/api";
import {
  type CreateExportRequest,
  ExportService,
  ExportState,
  ExportValues,
  FileFormatSchema,
} from "../../../web/src/gen/phrenic/v1/export_pb";
import { UploadService } from "../../../web/src/gen/phrenic/v1/upload_pb";
import type { Body } from "../../../web/src/geometry/bodies";
import { exportPanel } from "../../../web/src/panels/jobs/export_panel";
import { takeHomeRow } from "../../../web/src/panels/jobs/take_home";
import { uploadPanel } from "../../../web/src/panels/jobs/upload_panel";
import { Exports } from "../../../web/src/session/exports";
import { Uploads } from "../../../web/src/session/uploads";
import { Signal } from "../../../web/src/state/signal";

const file = new Uint8Array([1, 2, 3, 4, 5, 6, 7]);
let asked: CreateExportRequest[], deleted: string[], offsets: number[], breaks: number, problem: string;
let received: number[], refused: string;

const api = createApi(
  createRouterTransport(({ service }) => {
    service(ExportService, {
      listFormats: () => ({
        formats: [
          create(FileFormatSchema, { name: "msh", values: [ExportValues.DISPLACEMENTS, ExportValues.POSITIONS] }),
          create(FileFormatSchema, { name: "stl", instant: true }),
          create(FileFormatSchema, { name: "html", page: true }),
        ],
      }),
      createExport: (request) => {
        asked.push(request);
        return { job: { id: "e" } };
      },
      async *watchExport() {
        yield { job: { id: "e", state: ExportState.RUNNING, progress: 0.5, secondsLeft: 3 } };
        const state = problem === "" ? ExportState.DONE : ExportState.FAILED;
        yield { job: { id: "e", state, problem, bytes: BigInt(file.length), fileName: "class.msh" } };
      },
      async *downloadExport({ offset }) {
        offsets.push(Number(offset));
        yield { chunk: file.slice(Number(offset), Number(offset) + 3) };
        if (breaks-- > 0) throw new ConnectError("gone", Code.Unavailable);
        yield { chunk: file.slice(Number(offset) + 3) };
      },
      deleteExport: ({ exportId }) => {
        deleted.push(exportId);
        return {};
      },
    });
    service(UploadService, {
      listSurfaceFormats: () => ({ formats: [{ ending: ".obj" }, { ending: ".vtp" }] }),
      beginUpload: () => ({ uploadId: "u", received: 1n }),
      addUploadChunk: ({ offset, chunk }) => {
        received.push(...chunk);
        return { received: offset + BigInt(chunk.length) };
      },
      finishUpload: () => {
        if (refused !== "") throw new ConnectError(refused, Code.InvalidArgument);
        return { file: { path: "upload:ab" }, report: { vertices: 3, repairs: ["weld them"] } };
      },
    });
  }),
);
const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const pick = (id: string, value: string) => {
  const input = byId<HTMLSelectElement>(id);
  input.value = value;
  input.onchange?.(new Event("change"));
};

beforeEach(() => {
  [asked, deleted, offsets, received] = [[], [], [], []];
  [breaks, problem, refused] = [0, "", ""];
  URL.createObjectURL = () => "blob:there";
  URL.revokeObjectURL = () => undefined;
});

test("AnExportIsRecordedDownloadedAndDeleted", async () => {
  const exports = new Exports(api, "class");
  await exports.loadFormats();
  document.body.replaceChildren(exportPanel(exports, new Signal<Body[]>([])));
  pick("export-values", String(ExportValues.POSITIONS));
  pick("export-seconds", "4");
  await exports.start();
  expect(asked[0]).toMatchObject({ sessionId: "class", format: "msh", seconds: 4, values: ExportValues.POSITIONS });
  expect(exports.progress.value).toMatchObject({ kind: "ready", file: "class.msh", size: 7 });
  expect(byId<HTMLAnchorElement>("export-link").download).toBe("class.msh");
  expect(deleted).toEqual(["e"]);
  exports.choose({ format: "stl" });
  await exports.start();
  expect(asked[1]).toMatchObject({ format: "stl", seconds: 0, values: ExportValues.UNSPECIFIED });
  for (const each of document.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input, select")) {
    expect(each.labels?.length, each.id).toBe(1);
  }
});

test("APageHasOneBreathOfTheChosenBodies", async () => {
  const exports = new Exports(api, "class");
  await exports.loadFormats();
  document.body.replaceChildren(exportPanel(exports, new Signal<Body[]>([])));
  exports.choose({ format: "html", seconds: 9, bodies: ["lung"] });
  const rowOf = (id: string) => byId(id).closest<HTMLElement>(".labelled-row")!;
  expect([rowOf("export-seconds").hidden, rowOf("export-body").hidden]).toEqual([true, false]);
  expect(byId<HTMLSelectElement>("export-body").options[0].textContent).toBe("what the scene shows");
  await exports.start();
  expect(asked[0]).toMatchObject({ format: "html", seconds: 0, bodies: ["lung"] });
});

test("ABreathIsTakenHomeByOneButton", async () => {
  const exports = new Exports(api, "class");
  document.body.replaceChildren(takeHomeRow(exports));
  let saved = "";
  document.body.addEventListener("click", (event) => {
    if (event.target instanceof HTMLAnchorElement) saved = event.target.download;
  });
  byId("take-home").click();
  await vi.waitFor(() => expect(saved).toBe("class.msh"));
  expect(asked[0]).toMatchObject({ format: "html", seconds: 0, bodies: [] });
});

test("AnInterruptedDownloadResumes", async () => {
  breaks = 1;
  const exports = new Exports(api, "class", 0);
  await exports.start();
  expect(offsets).toEqual([0, 3]);
  expect(exports.progress.value).toMatchObject({ kind: "ready", size: 7 });
});

test("AFailureShowsTheServersMessage", async () => {
  problem = "time_step: too long";
  const exports = new Exports(api, "class");
  document.body.replaceChildren(exportPanel(exports, new Signal<Body[]>([])));
  await exports.start();
  expect(document.querySelector("#export-progress [role=alert]")?.textContent).toBe("time_step: too long");
});

test("AnUploadResumesAndShowsItsNameForScenes", async () => {
  const uploads = new Uploads(api);
  document.body.replaceChildren(uploadPanel(uploads));
  await uploads.loadFormats();
  expect(byId<HTMLInputElement>("upload-file").accept).toBe(".obj,.vtp");
  const local = { name: "a.obj", size: 7, arrayBuffer: async () => file.slice().buffer as ArrayBuffer };
  await uploads.upload(local);
  expect(received).toEqual([2, 3, 4, 5, 6, 7]);
  expect(byId<HTMLInputElement>("upload-path").value).toBe("upload:ab");
  expect(document.body.textContent).toContain("weld them");
  refused = "a.obj:2: the vertex's z is missing";
  await uploads.upload(local);
  expect(document.querySelector("#upload-progress [role=alert]")?.textContent).toBe(refused);
});
