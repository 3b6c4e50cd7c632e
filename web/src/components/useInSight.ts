/** Whether an element can be seen now: within the page's window, in a tab that is shown. */
import { type RefObject, useEffect, useState } from "react";

export function useInSight(element: RefObject<Element | null>): boolean {
  const [within, setWithin] = useState(false);
  const [shown, setShown] = useState(() => !document.hidden);
  useEffect(() => {
    const target = element.current;
    if (target === null) return;
    const observer = new IntersectionObserver((entries) => setWithin(entries.at(-1)?.isIntersecting ?? false));
    observer.observe(target);
    return () => observer.disconnect();
  }, [element]);
  useEffect(() => {
    const change = () => setShown(!document.hidden);
    document.addEventListener("visibilitychange", change);
    return () => document.removeEventListener("visibilitychange", change);
  }, []);
  return within && shown;
}
