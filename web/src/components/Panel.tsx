/** A titled part of the page. */
import { type ReactNode, useId } from "react";

interface PanelProps {
  title: string;
  /** What stands at the right end of the title line. */
  aside?: ReactNode;
  className?: string;
  role?: "group" | "region";
  children: ReactNode;
}

export function Panel({ title, aside, className = "", role = "region", children }: PanelProps) {
  const heading = useId();
  return (
    <section className={`panel ${className}`} role={role} aria-labelledby={heading}>
      <header className="panel-head">
        <h2 id={heading}>{title}</h2>
        {aside}
      </header>
      {children}
    </section>
  );
}
