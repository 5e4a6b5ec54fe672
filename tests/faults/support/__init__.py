"""What the fault injections share: the platform as real processes, faults to do to them, eyes to see with."""
