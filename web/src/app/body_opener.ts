import type { BodyDialog } from "../body/body_dialog";
import type { Api } from "../connection/api";

/** Returns what opens the dialog that makes a body, whose code is loaded then; `open` opens its session. */
export function bodyOpener(api: Api, open: (sessionId: string) => void): () => Promise<void> {
  let dialog: BodyDialog | undefined;
  return async () => {
    const { BodyDialog } = await import("../body/body_dialog");
    dialog ??= new BodyDialog(api, open);
    dialog.show();
  };
}
