import { elementById } from "../dom/elements";
import { showStudy } from "./page";

showStudy(elementById("page"), elementById("study").textContent ?? "");
