# SPDX-License-Identifier: GPL-3.0-or-later
"""Client of the Easeoff service. Start with Client; documents.py names what the documents hold."""

from .client import Client, JobFailed, Stored
from .transport import Event, Problem

__all__ = ["Client", "Event", "JobFailed", "Problem", "Stored"]
