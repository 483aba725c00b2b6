import { type Client, ConnectError, createClient, type Transport } from "@connectrpc/connect";
import { AccessService } from "../gen/phrenic/v1/access_pb";
import { CompareService } from "../gen/phrenic/v1/compare_pb";
import { ControlService } from "../gen/phrenic/v1/control_pb";
import { ExportService } from "../gen/phrenic/v1/export_pb";
import { FrameService } from "../gen/phrenic/v1/frames_pb";
import { ReferenceService } from "../gen/phrenic/v1/references_pb";
import { SampleService } from "../gen/phrenic/v1/samples_pb";
import { SceneService, SessionService } from "../gen/phrenic/v1/session_pb";
import { TissueService } from "../gen/phrenic/v1/tissue_pb";
import { UploadService } from "../gen/phrenic/v1/upload_pb";

/** Clients of the services that the page uses from its start, over one transport: gRPC-web in the page, a router in tests. */
export interface Api {
  /** For the clients of services that only parts use which are loaded later. */
  transport: Transport;
  access: Client<typeof AccessService>;
  scenes: Client<typeof SceneService>;
  sessions: Client<typeof SessionService>;
  control: Client<typeof ControlService>;
  frames: Client<typeof FrameService>;
  comparisons: Client<typeof CompareService>;
  exports: Client<typeof ExportService>;
  uploads: Client<typeof UploadService>;
  references: Client<typeof ReferenceService>;
  samples: Client<typeof SampleService>;
  tissue: Client<typeof TissueService>;
}

/** Creates the clients over one transport. */
export function createApi(transport: Transport): Api {
  return {
    transport,
    access: createClient(AccessService, transport),
    scenes: createClient(SceneService, transport),
    sessions: createClient(SessionService, transport),
    control: createClient(ControlService, transport),
    frames: createClient(FrameService, transport),
    comparisons: createClient(CompareService, transport),
    exports: createClient(ExportService, transport),
    uploads: createClient(UploadService, transport),
    references: createClient(ReferenceService, transport),
    samples: createClient(SampleService, transport),
    tissue: createClient(TissueService, transport),
  };
}

/** True if a call failed before a server could answer; browsers then throw a TypeError. */
export function isUnreachable(error: unknown): boolean {
  return error instanceof ConnectError && error.cause instanceof TypeError;
}

/** Returns the message of an error without its status code. */
export function errorText(error: unknown): string {
  if (isUnreachable(error)) return "the server cannot be reached";
  return ConnectError.from(error).rawMessage || "the server gave no reason";
}
