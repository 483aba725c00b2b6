import { place } from "../dom/elements";
import { showStudy } from "./page";

showStudy(place("page"), place("study").textContent ?? "");
