/// <reference types="vite/client" />

/** The script of the laboratory's workers, as text. */
declare module 'virtual:lab-worker' {
  const text: string;
  export default text;
}
