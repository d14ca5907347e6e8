/// What a view of the page can be asked for by the shell around it.
export interface View {
  dispose: () => void;
  /// Whether it knew the key.
  key?: (key: string, event: KeyboardEvent) => boolean;
  drop?: (files: File[]) => void;
}
