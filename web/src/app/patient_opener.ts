import type { Api } from "../connection/api";
import type { PatientDialog } from "../patient/patient_dialog";
import type { Dropped } from "../patient/patient_files";

/** Opens the dialog that makes a patient, of what was dropped or of a file that the user chooses there. */
export type PatientOpener = (dropped?: Dropped) => Promise<void>;

/** Returns what opens the dialog, whose code is loaded then; `open` opens the session of a patient. */
export function patientOpener(api: Api, open: (sessionId: string) => void): PatientOpener {
  let dialog: PatientDialog | undefined;
  return async (dropped) => {
    const { PatientDialog } = await import("../patient/patient_dialog");
    dialog ??= new PatientDialog(api, open);
    await dialog.start(dropped);
  };
}
