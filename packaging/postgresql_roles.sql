-- Roles of a PostgreSQL database of results with the least rights (docs/results.md). Run it in that database, once, as
-- an administrator of the server:
--     createdb trocar
--     psql -d trocar -v ON_ERROR_STOP=1 -f postgresql_roles.sql
-- then give both a password: \password trocar_owner, \password trocar_writer.
--
-- trocar_owner makes the tables and brings them up to date: run any command with it once, and after each update of
--     Trocar: trocar results --db postgresql://trocar_owner@HOST/trocar people
-- trocar_writer reads and writes rows, and no more: for the trainer, trocar results and trocar serve.
DO $$
BEGIN
  IF NOT EXISTS (SELECT 1 FROM pg_roles WHERE rolname = 'trocar_owner') THEN
    CREATE ROLE trocar_owner LOGIN NOSUPERUSER NOCREATEDB NOCREATEROLE;
  END IF;
  IF NOT EXISTS (SELECT 1 FROM pg_roles WHERE rolname = 'trocar_writer') THEN
    CREATE ROLE trocar_writer LOGIN NOSUPERUSER NOCREATEDB NOCREATEROLE;
  END IF;
  EXECUTE format('REVOKE ALL ON DATABASE %I FROM PUBLIC', current_database());
  EXECUTE format('GRANT CONNECT ON DATABASE %I TO trocar_owner, trocar_writer', current_database());
END
$$;

REVOKE ALL ON SCHEMA public FROM PUBLIC;
GRANT USAGE, CREATE ON SCHEMA public TO trocar_owner;
GRANT USAGE ON SCHEMA public TO trocar_writer;

-- Tables that trocar_owner makes from now on.
ALTER DEFAULT PRIVILEGES FOR ROLE trocar_owner IN SCHEMA public
  GRANT SELECT, INSERT, UPDATE, DELETE ON TABLES TO trocar_writer;
ALTER DEFAULT PRIVILEGES FOR ROLE trocar_owner IN SCHEMA public
  GRANT USAGE ON SEQUENCES TO trocar_writer;

-- Tables that are there already: those of another owner become trocar_owner's.
DO $$
DECLARE
  relation record;
BEGIN
  -- The sequence of a key goes with its table.
  FOR relation IN SELECT tablename FROM pg_tables WHERE schemaname = 'public' LOOP
    EXECUTE format('ALTER TABLE public.%I OWNER TO trocar_owner', relation.tablename);
  END LOOP;
END
$$;
GRANT SELECT, INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA public TO trocar_writer;
GRANT USAGE ON ALL SEQUENCES IN SCHEMA public TO trocar_writer;
