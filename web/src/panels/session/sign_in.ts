import type { Api } from "../../connection/api";
import type { Credentials } from "../../connection/credentials";
import { make } from "../../dom/elements";
import { t } from "../../language/translate";

/** True if the server has no accounts, knows the user, or a join link may be sufficient. */
async function isAdmitted(api: Api, credentials: Credentials): Promise<boolean> {
  const { accounts, name } = await api.access.getAccess({}, { timeoutMs: 8000 });
  return !accounts || name !== "" || (credentials.token === "" && credentials.joinLinks.length > 0);
}

/** Asks for the account token, in `place`, until the server accepts it. Returns immediately if none is needed. */
export async function signIn(api: Api, credentials: Credentials, place: HTMLElement): Promise<void> {
  // Errors of an unreachable server are reported by the next call.
  for (let first = true; !(await isAdmitted(api, credentials).catch(() => true)); first = false) {
    const entry = make("input", { type: "password", autocomplete: "current-password", required: true });
    const label = make("label", {}, t("Your token "), entry);
    const button = make("button", { type: "submit" }, t("Sign in"));
    const form = make("form", { id: "sign-in" }, label, " ", button);
    const words = first ? t("This server requires an account. ") : t("No account has this token. ");
    place.replaceChildren(words, form);
    entry.focus();
    credentials.token = await new Promise<string>((done) => {
      form.onsubmit = (event) => {
        event.preventDefault();
        done(entry.value.trim());
      };
    });
  }
}
