"""What menus, buttons and keys do: one file a menu. Commands ask, start work, and hand the result to the session."""
