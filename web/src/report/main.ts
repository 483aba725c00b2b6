import { place } from "../panels/dom";
import { showStudy } from "./page";

showStudy(place("page"), place("study").textContent ?? "");
