import { type Api, errorText } from "../connection/api";
import type { Identity } from "../connection/identity";
import type { AnswerPhase, ClassAnswer } from "../gen/phrenic/v1/answers_pb";

/** A question of a lesson: the lesson's name, the number of the step from 1, and when it is asked. */
export interface QuestionPlace {
  lesson: string;
  step: number;
  phase: AnswerPhase;
}

/** What was answered: the indices of the chosen answers, or a number. */
export interface GivenAnswer {
  choices: number[];
  number: number | undefined;
  right: boolean;
}

/** The answers of a class: this browser's go to the server, and who controls the session may list all. */
export class ClassAnswers {
  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
    private readonly identity: Identity,
  ) {}

  /** Sends an answer. A lost connection loses it, and the lesson goes on: the answer is checked in the page. */
  async submit(place: QuestionPlace, answer: GivenAnswer): Promise<void> {
    const { respondent, name } = this.identity;
    const request = { sessionId: this.sessionId, respondent, name, ...place, ...answer };
    await this.api.sessions.submitAnswer(request).catch(() => undefined);
  }

  /** Returns the answers of the class to a lesson. Throws Error with the server's reason if it refuses. */
  async list(lesson: string, includeNames: boolean): Promise<ClassAnswer[]> {
    const request = { sessionId: this.sessionId, lesson, includeNames };
    const refused = (error: unknown) => Promise.reject(new Error(errorText(error)));
    return (await this.api.sessions.listAnswers(request).catch(refused)).answers;
  }
}
