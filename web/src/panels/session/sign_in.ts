import type { Api } from "../../connection/api";
import type { Credentials } from "../../connection/credentials";
import { make } from "../../dom/elements";

/** Whether the server takes this browser as it is: it knows no users, knows this one, or a join link may do. */
async function isAdmitted(api: Api, access: Credentials): Promise<boolean> {
  const { accounts, name } = await api.access.getAccess({}, { timeoutMs: 8000 });
  return !accounts || name !== "" || (access.token === "" && access.joinLinks.length > 0);
}

/** Asks for the account's token, in `place`, until the server knows it; at once where none is needed. */
export async function signIn(api: Api, access: Credentials, place: HTMLElement): Promise<void> {
  // A server that does not answer is told of by whoever asks next.
  for (let first = true; !(await isAdmitted(api, access).catch(() => true)); first = false) {
    const entry = make("input", { type: "password", autocomplete: "current-password", required: true });
    const label = make("label", {}, "Your token ", entry);
    const button = make("button", { type: "submit" }, "Sign in");
    const form = make("form", { id: "sign-in" }, label, " ", button);
    const words = first ? "This server knows its users. " : "Nobody has that token. ";
    place.replaceChildren(words, form);
    entry.focus();
    access.token = await new Promise<string>((done) => {
      form.onsubmit = (event) => {
        event.preventDefault();
        done(entry.value.trim());
      };
    });
  }
}
